/* Names and sentences of reasons. */
#include <lensprof/reason.h>

typedef struct reason_row {
    uint32_t code;
    const char *name, *text;
} reason_row;

#define ROW(code, name, text) \
    { LENSPROF_REASON_##code, name, text }

static const reason_row rows[] = {
    ROW(NONE, "none", ""),
    ROW(IMAGE_GROUPS, "image_groups", "the images fall into groups that no usable overlap joins"),
    ROW(FEW_PAIRS, "few_pairs", "there are too few different pairs between black and white"),
    ROW(FEW_AGREE, "few_agree", "too few pairs agree with one camera model"),
    ROW(STILL_FEW_AGREE, "still_few_agree", "too few pairs of a camera that did not move agree with one response"),
    ROW(SCATTER, "scatter", "the pairs scatter too far about the best camera model"),
    ROW(NOT_SETTLED, "not_settled", "the fit did not settle"),
    ROW(UNDETERMINED, "undetermined",
        "the pairs do not determine all parameters; fix some, or take pictures of more exposures"),
    ROW(FEW_BEHIND_EXPOSURE, "few_behind_exposure",
        "an image's exposure rests on too few pairs that agree with the camera model"),
    ROW(STILL_FEW_BEHIND_EXPOSURE, "still_few_behind_exposure",
        "an image's exposure rests on too few pairs that agree with the response"),
    ROW(IMAGE_DISAGREES, "image_disagrees", "hardly any pair of an image agrees with the camera model"),
    ROW(STILL_IMAGE_DISAGREES, "still_image_disagrees", "hardly any pair of an image agrees with the response"),
    ROW(PATTERNS, "patterns",
        "the residual follows patterns of each image's own, which no response and falloff explain"),
    ROW(PATTERNS_HELD, "patterns_held",
        "the residual follows patterns of each image's own, which the response or falloff that are held do not explain"),
    ROW(STILL_PATTERNS, "still_patterns",
        "the residual follows patterns of each image's own, which no response explains"),
    ROW(IMAGE_ODD, "image_odd", "most pairs of an image disagree with the camera model"),
    ROW(STILL_IMAGE_ODD, "still_image_odd", "most pairs of an image disagree with the response"),
    ROW(WEAK_PATTERNS, "weak_patterns",
        "the residual follows patterns of each image's own, as weak local tone mapping makes them"),
    ROW(EXPOSURE_UNCERTAIN, "exposure_uncertain", "the pairs leave an image's exposure uncertain"),
    ROW(KNOWN_ALIKE, "known_alike", "the known exposures hardly differ, which shows no response"),
    ROW(KNOWN_REVERSED, "known_reversed",
        "the response falls: pictures that are brighter have the smaller known exposures; check these, and their order"),
    ROW(EXPOSURES_ALIKE, "exposures_alike", "the pictures hardly differ in exposure, which shows no response"),
    ROW(KNOWN_ORDER, "known_order", "the known exposures do not follow the pictures"),
    ROW(KNOWN_WRONG, "known_wrong", "an image's exposure is far from its known one"),
    ROW(KNOWN_MORE_FROM, "known_more_from", "from one image on the known exposures are more than the pictures"),
    ROW(KNOWN_LESS_FROM, "known_less_from", "from one image on the known exposures are less than the pictures"),
    ROW(KNOWN_CONTRADICT, "known_contradict", "the known exposures contradict each other"),
    ROW(GAMMA_UNFOLLOWED, "gamma_unfollowed", "the response cannot follow the exponent of the known exposures"),
    ROW(FEW_GREYS, "few_greys", "the pairs cover too few grey values to show a response"),
    ROW(MISSING_GREYS, "missing_greys", "the pairs leave out a range of grey values"),
    ROW(UNUSUAL_RESPONSE, "unusual_response", "the response is unlike those of measured cameras of this kind"),
    ROW(SMALL_RADIUS, "small_radius", "the pairs do not reach the corners"),
    ROW(CORNER_UNCERTAIN, "corner_uncertain", "the pairs leave the falloff in the corners uncertain"),
    ROW(FALLOFF_RISES, "falloff_rises", "the falloff rises away from the middle, as of no lens"),
    ROW(CENTER_ON_LIMIT, "center_on_limit", "the centre of the falloff is at the limit of what is allowed"),
    ROW(NOT_RADIAL, "not_radial", "the residual follows one pattern over the frame: the falloff is not radial"),
    ROW(FAR_CENTER, "far_center", "the centre of the falloff lies far from the middle of the frame"),
    ROW(FALLOFF_RISES_SOME, "falloff_rises_some", "the falloff rises a little away from the middle"),
    ROW(FLAT_WHITE, "flat_white", "a part of the card is white in every exposure"),
    ROW(FLAT_BLACK, "flat_black", "a part of the card is black in every exposure"),
    ROW(FLAT_NO_CARD, "flat_no_card", "no card was found in a shot"),
    ROW(FLAT_FEW_CELLS, "flat_few_cells", "there are too few cells of even light"),
    ROW(FLAT_SMALL_RADIUS, "flat_small_radius", "the card does not reach the corners"),
    ROW(FLAT_RESPONSE_STEP, "flat_response_step", "the response given is a step where the grey values of an image lie"),
    ROW(FLAT_RESPONSE_LEVEL, "flat_response_level", "the response given is flat where the grey values of an image lie"),
    ROW(FLAT_EXPOSURE_WRONG, "flat_exposure_wrong", "an image is far from the others of its shot"),
    ROW(FLAT_TEXTURE, "flat_texture", "the card is not even"),
    ROW(FLAT_SHOTS_DIFFER, "flat_shots_differ", "the shots differ in ways that one lens and one light do not explain"),
    ROW(FLAT_FEW_AGREE, "flat_few_agree", "too few cells agree with one falloff and one light"),
    ROW(FLAT_STEEP, "flat_steep", "the light of a shot changes too much over the frame"),
    ROW(FLAT_STEEP_ALONE, "flat_steep_alone",
        "the light of a shot changes over the frame, and no turned shot tells it from the lens"),
    ROW(FLAT_UNDETERMINED, "flat_undetermined",
        "the pictures do not determine all parameters: hold the centre, take the light as even, or add a shot with the camera turned"),
    ROW(FLAT_CORNER_NOT_RADIAL, "flat_corner_not_radial",
        "what is not radial leaves the falloff in the corners uncertain"),
    ROW(FLAT_CORNER_UNCERTAIN, "flat_corner_uncertain",
        "the falloff in the corners is uncertain: too noisy, or the card is not seen there"),
    ROW(FLAT_EXTRAPOLATED, "flat_extrapolated", "the card does not reach the corners: their falloff is extrapolated"),
    ROW(FLAT_SOME_WHITE, "flat_some_white", "a small part of the card is white in every exposure and was left out"),
    ROW(FLAT_SOME_BLACK, "flat_some_black", "a small part of the card is black in every exposure and was left out"),
    ROW(FLAT_EXPOSURE_DOUBTFUL, "flat_exposure_doubtful", "an image is somewhat away from the others of its shot"),
    ROW(FLAT_SHOTS_DIFFER_SOME, "flat_shots_differ_some",
        "the shots differ somewhat in ways that one lens and one light do not explain"),
    ROW(FLAT_SOME_TEXTURE, "flat_some_texture", "the card has some texture"),
    ROW(FLAT_SLANTED_LIGHT, "flat_slanted_light",
        "the light changes over the frame, and the centre rests on its prior"),
    ROW(FLAT_NOT_RADIAL_GRID, "flat_not_radial_grid", "a part of the light is not radial: the gain grid takes it"),
    ROW(FLAT_NOT_RADIAL, "flat_not_radial", "a part of the light is not radial; ask for a gain grid"),
    ROW(FLAT_FAR_CENTER, "flat_far_center",
        "the centre of the falloff lies far from the middle of the frame, or the light is not even"),
    ROW(FLAT_CENTER_BY_PRIOR, "flat_center_by_prior",
        "no turned shot tells the light's gradient from the lens: the centre rests on its prior"),
    ROW(FLAT_DUST, "flat_dust", "spots of dust were left out"),
    ROW(LOOKUP_NO_LENS, "lookup_no_lens",
        "no profile of a lens of this name; list the profiles to see which there are"),
    ROW(LOOKUP_NO_CAMERA, "lookup_no_camera", "no profile of this camera; list the profiles to see which there are"),
    ROW(LOOKUP_OTHER_PROCESSING, "lookup_other_processing",
        "the profiles of this lens are of pictures whose falloff the camera has corrected"),
    ROW(LOOKUP_DOUBTFUL, "lookup_doubtful",
        "all profiles of this lens are doubtful; ask for doubtful ones, too, to use them"),
    ROW(LOOKUP_OTHER_CAMERA, "lookup_other_camera",
        "the profiles of this lens are of single units of it; ask for one of these"),
    ROW(LOOKUP_SEVERAL_LENSES, "lookup_several_lenses", "this camera has profiles of several lenses; give the lens"),
    ROW(LOOKUP_SMALLER_SENSOR, "lookup_smaller_sensor", "this lens was measured on smaller sensors only"),
    ROW(LOOKUP_FOCAL_MISSING, "lookup_focal_missing",
        "the focal length is not known, and the lens has several; give it"),
    ROW(LOOKUP_APERTURE_MISSING, "lookup_aperture_missing",
        "the aperture is not known, and the lens has several; give it"),
    ROW(LOOKUP_NO_FOCAL, "lookup_no_focal", "no profile of this lens has a focal length"),
    ROW(LOOKUP_NO_APERTURE, "lookup_no_aperture", "no profile of this lens has an aperture"),
    ROW(LOOKUP_FOCAL_BEYOND, "lookup_focal_beyond", "the focal length is beyond those at which this lens is known"),
    ROW(LOOKUP_APERTURE_BEYOND, "lookup_aperture_beyond", "the aperture is beyond those at which this lens is known"),
    ROW(LOOKUP_TOO_FAR, "lookup_too_far", "the nearest profile of this lens is too far from this setting"),
    ROW(LOOKUP_CONTRADICTION, "lookup_contradiction",
        "the profiles near it contradict each other: no valid falloff lies between them"),
    ROW(LOOKUP_CORRECTED, "lookup_corrected",
        "the camera has corrected the falloff of such pictures, and what it leaves is not stored; insist on the lens's "
        "falloff where it has not"),
    ROW(LOOKUP_FOCAL_ROUNDED, "lookup_focal_rounded",
        "the focal length is rounded differently than in the profiles of this camera"),
    ROW(LOOKUP_FOCAL_OUTSIDE, "lookup_focal_outside", "the focal length is outside those that are stored"),
    ROW(LOOKUP_APERTURE_OUTSIDE, "lookup_aperture_outside", "the aperture is outside those that are stored"),
    ROW(LOOKUP_OTHER_LIGHT, "lookup_other_light",
        "the profiles are of light of other colour temperatures: those of the nearest are taken"),
    ROW(LOOKUP_SMALLEST_SENSOR, "lookup_smallest_sensor",
        "the sensor's size is not known: of those measured the smallest is taken"),
    ROW(LOOKUP_BY_WORDS, "lookup_by_words", "the lens was found by the words and numbers of its name"),
    ROW(LOOKUP_BUILT_IN, "lookup_built_in", "no lens of this name; that of the camera is built in"),
    ROW(LOOKUP_WEAKEST_DISTANCE, "lookup_weakest_distance",
        "the focus distance is not known: the weakest falloff of those stored is taken"),
    ROW(LOOKUP_FARTHEST_DISTANCE, "lookup_farthest_distance",
        "the focus distance is not known: the falloff at the farthest one stored is taken"),
    ROW(LOOKUP_USUAL_DISTANCE, "lookup_usual_distance",
        "the focus distance is not known: the mean falloff over usual distances is taken"),
    ROW(LOOKUP_UNKNOWN_SENSOR, "lookup_unknown_sensor",
        "the sensor's size is not known: that of the profiles is taken"),
    ROW(LOOKUP_ON_OTHER_CAMERA, "lookup_on_other_camera", "the falloff was measured on other cameras"),
    ROW(LOOKUP_TYPICAL_RESPONSE, "lookup_typical_response",
        "no response of this camera is stored: the typical one of its kind is taken"),
    ROW(LOOKUP_OTHER_STYLE, "lookup_other_style", "the camera's response is stored for other picture styles only"),
    ROW(PRIOR_OVERRULED, "prior_overruled", "the profile given as the prior contradicts the pictures and was left out"),
    ROW(PRIOR_RESPONSE_OVERRULED, "prior_response_overruled",
        "the response given as the prior contradicts the pictures"),
    ROW(PRIOR_FALLOFF_OVERRULED, "prior_falloff_overruled", "the falloff given as the prior contradicts the pictures"),
};

#undef ROW

static const reason_row *find_row(uint32_t reason) {
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].code == reason) return &rows[i];
    return NULL;
}

const char *lensprof_reason_name(uint32_t reason) {
    const reason_row *row = find_row(reason);
    return row ? row->name : "unknown";
}

const char *lensprof_reason_text(uint32_t reason) {
    const reason_row *row = find_row(reason);
    return row ? row->text : "";
}
