/* Names and descriptions of reasons. */
#include <lensprof/reason.h>

typedef struct reason_row {
    uint32_t code;
    const char *name, *text;
} reason_row;

#define ROW(code, name, text) \
    { LENSPROF_REASON_##code, name, text }

static const reason_row rows[] = {
    ROW(NONE, "none", ""),
    ROW(IMAGE_GROUPS, "image_groups", "no usable overlap connects some groups of images"),
    ROW(FEW_PAIRS, "few_pairs", "too few different pairs between black and white"),
    ROW(FEW_AGREE, "few_agree", "too few of the pairs agree with one camera model"),
    ROW(SCATTER, "scatter", "the pairs scatter too far about the best camera model"),
    ROW(NOT_CONVERGED, "not_converged", "the fit did not converge"),
    ROW(UNDETERMINED, "undetermined", "the data do not determine all parameters"),
    ROW(FEW_INLIERS, "few_inliers", "too few pairs that agree determine an image's exposure"),
    ROW(IMAGE_DISAGREES, "image_disagrees", "almost no pair of an image agrees with the result"),
    ROW(PATTERNS, "patterns", "the residual follows a pattern of its own in each image, typical of local tone mapping"),
    ROW(IMAGE_INCONSISTENT, "image_inconsistent", "most pairs of an image disagree with the result"),
    ROW(IMAGES_LEFT_OUT, "images_left_out", "images that do not agree with the others were left out"),
    ROW(IMAGES_UNCONNECTED, "images_unconnected", "images that no pairs connect to the others were left out"),
    ROW(MANY_OUTLIERS, "many_outliers", "many pairs disagree with the camera model"),
    ROW(SEAMS_REMAIN, "seams_remain", "overlapping pictures still differ after correction"),
    ROW(LINKS_UNVERIFIED, "links_unverified",
        "the overlaps of some images have too little texture to verify their alignment"),
    ROW(IMAGES_MINORITY, "images_minority", "fewer than half of the images of the set take part in the result"),
    ROW(LINKS_CONTRADICT, "links_contradict", "pairs of two images contradict the other pairs and were left out"),
    ROW(EXPOSURE_UNCERTAIN, "exposure_uncertain", "the pairs leave an image's exposure uncertain"),
    ROW(EXPOSURES_EQUAL, "exposures_equal", "the exposures of the pictures differ too little to determine a response"),
    ROW(KNOWN_ORDER, "known_order", "the order of the known exposures contradicts the pictures"),
    ROW(KNOWN_WRONG, "known_wrong", "an image's exposure is far from its known value"),
    ROW(KNOWN_STEP, "known_step", "from one image on, the known exposures differ from those of the pictures"),
    ROW(KNOWN_CONTRADICT, "known_contradict", "the known exposures contradict each other"),
    ROW(GAMMA_INCONSISTENT, "gamma_inconsistent", "the response cannot match the exponent of the known exposures"),
    ROW(WHITE_BALANCE_FIXED, "white_balance_fixed", "white balances are fixed, but differ between the pictures"),
    ROW(FEW_GREYS, "few_greys", "the pairs cover too few grey values to determine a response"),
    ROW(MISSING_GREYS, "missing_greys", "the pairs miss a range of grey values"),
    ROW(UNUSUAL_RESPONSE, "unusual_response", "the response is unlike measured cameras of this kind"),
    ROW(RESPONSE_UNCONSTRAINED, "response_unconstrained",
        "the pictures do not constrain the response: the one known before is used"),
    ROW(SMALL_RADIUS, "small_radius", "nothing seen reaches the corners"),
    ROW(CORNER_UNCERTAIN, "corner_uncertain", "the falloff in the corners is uncertain"),
    ROW(FALLOFF_RISES, "falloff_rises", "the falloff rises away from the centre"),
    ROW(FALLOFF_DARK, "falloff_dark", "the falloff leaves less light than any lens"),
    ROW(SAME_VIEW, "same_view", "the pictures show almost the same view, which determines no falloff"),
    ROW(EXPOSURES_ONLY, "exposures_only", "response and falloff predict the pictures no better than exposures alone"),
    ROW(NOTHING_BETTER, "nothing_better", "no correction makes the pictures differ less"),
    ROW(CENTER_ON_LIMIT, "center_on_limit", "the centre of the falloff is at the limit of its range"),
    ROW(NOT_RADIAL, "not_radial", "the residual has one pattern over the frame: the falloff is not radial"),
    ROW(FAR_CENTER, "far_center", "the centre of the falloff is far from the middle of the frame"),
    ROW(FEW_IMAGES, "few_images", "a moving camera took too few images to tell falloff from changing objects"),
    ROW(FLAT_WHITE, "flat_white", "a part of the card is white in every exposure"),
    ROW(FLAT_BLACK, "flat_black", "a part of the card is black in every exposure"),
    ROW(FLAT_NO_CARD, "flat_no_card", "no card was found in a shot"),
    ROW(FLAT_FEW_CELLS, "flat_few_cells", "too few evenly lit cells"),
    ROW(FLAT_RESPONSE, "flat_response",
        "the given response does not determine the light at the grey values of an image"),
    ROW(FLAT_EXPOSURE_WRONG, "flat_exposure_wrong", "an image deviates from the others of its shot"),
    ROW(FLAT_TEXTURE, "flat_texture", "the card is not uniform"),
    ROW(FLAT_SHOTS_DIFFER, "flat_shots_differ", "the shots differ more than one lens and one light explain"),
    ROW(FLAT_STEEP, "flat_steep", "the light of a shot varies over the frame"),
    ROW(FLAT_NOT_RADIAL, "flat_not_radial", "a part of the light is not radial"),
    ROW(FLAT_CENTER_BY_PRIOR, "flat_center_by_prior",
        "no rotated shot separates the gradient of the light from the falloff: the centre depends on its prior"),
    ROW(FLAT_DUST, "flat_dust", "spots of dust were left out"),
    ROW(FLAT_EDGE, "flat_edge", "the image circle, or something in front of the lens, ends within the frame"),
    ROW(FLAT_ONE_LIGHT, "flat_one_light", "a light that is brighter in the middle looks like falloff"),
    ROW(FLAT_BLACK_LEVEL, "flat_black_level", "the falloff in the corners depends on the black level"),
    ROW(FLAT_NEEDS_GRID, "flat_needs_grid", "the falloff is not a polynomial in r^2: k1..k3 alone do not describe it"),
    ROW(FIELDS_FEW, "fields_few", "few pictures, or all of them the same"),
    ROW(FIELDS_REPEATED, "fields_repeated", "pictures that repeat another one were left out"),
    ROW(FIELDS_PATTERN, "fields_pattern", "the pictures have a pattern in common that is not smooth"),
    ROW(FIELDS_UNCERTAIN, "fields_uncertain", "the shading has a large error"),
    ROW(FIELDS_OFFSET, "fields_offset", "the pictures do not determine the offset, which was taken as 0"),
    ROW(FIELDS_WHITE, "fields_white", "a part of the pictures is saturated"),
    ROW(FIELDS_BLACK, "fields_black", "pictures without light were left out"),
    ROW(FIELDS_UNSEEN, "fields_unseen", "a part of the frame is usable in no picture"),
    ROW(FIELDS_GAIN, "fields_gain", "an even frame predicts held-out pictures as well as the shading"),
    ROW(LOOKUP_NO_LENS, "lookup_no_lens", "no profile of a lens with this name; list the profiles to see the names"),
    ROW(LOOKUP_NO_CAMERA, "lookup_no_camera", "no profile of this camera; list the profiles to see the cameras"),
    ROW(LOOKUP_OTHER_PROCESSING, "lookup_other_processing",
        "the profiles of this lens are for pictures whose falloff the camera corrected"),
    ROW(LOOKUP_DOUBTFUL, "lookup_doubtful", "all profiles of this lens are doubtful; allow doubtful ones to use them"),
    ROW(LOOKUP_OTHER_CAMERA, "lookup_other_camera",
        "the profiles of this lens are for single units; request one of them"),
    ROW(LOOKUP_SEVERAL_LENSES, "lookup_several_lenses", "this camera has profiles of several lenses; specify the lens"),
    ROW(LOOKUP_SMALLER_SENSOR, "lookup_smaller_sensor", "this lens was measured on smaller sensors only"),
    ROW(LOOKUP_FOCAL_MISSING, "lookup_focal_missing",
        "the focal length is unknown, and the lens has several; specify it"),
    ROW(LOOKUP_APERTURE_MISSING, "lookup_aperture_missing",
        "the aperture is unknown, and the lens has several; specify it"),
    ROW(LOOKUP_NO_FOCAL, "lookup_no_focal", "no profile of this lens has a focal length"),
    ROW(LOOKUP_NO_APERTURE, "lookup_no_aperture", "no profile of this lens has an aperture"),
    ROW(LOOKUP_FOCAL_BEYOND, "lookup_focal_beyond", "the focal length is beyond the range known for this lens"),
    ROW(LOOKUP_APERTURE_BEYOND, "lookup_aperture_beyond", "the aperture is beyond the range known for this lens"),
    ROW(LOOKUP_TOO_FAR, "lookup_too_far", "the nearest profile of this lens is too far from this setting"),
    ROW(LOOKUP_CONTRADICTION, "lookup_contradiction",
        "the nearest profiles contradict each other: interpolation gives no valid falloff"),
    ROW(LOOKUP_CORRECTED, "lookup_corrected",
        "the camera corrects the falloff of such pictures, and no profile of the remaining falloff is stored; "
        "if the camera did not correct it, force the profile of the lens"),
    ROW(LOOKUP_FOCAL_ROUNDED, "lookup_focal_rounded",
        "the focal length is rounded differently from the profiles of this camera"),
    ROW(LOOKUP_FOCAL_OUTSIDE, "lookup_focal_outside", "the focal length is outside the stored range"),
    ROW(LOOKUP_APERTURE_OUTSIDE, "lookup_aperture_outside", "the aperture is outside the stored range"),
    ROW(LOOKUP_OTHER_LIGHT, "lookup_other_light",
        "the profiles are for other colour temperatures: the nearest is used"),
    ROW(LOOKUP_SMALLEST_SENSOR, "lookup_smallest_sensor",
        "the sensor size is unknown: the smallest measured one is used"),
    ROW(LOOKUP_BY_WORDS, "lookup_by_words", "the lens was matched by the words and numbers of its name"),
    ROW(LOOKUP_BUILT_IN, "lookup_built_in", "no lens with this name; the camera's built-in lens is used"),
    ROW(LOOKUP_WEAKEST_DISTANCE, "lookup_weakest_distance",
        "the focus distance is unknown: the weakest stored falloff is used"),
    ROW(LOOKUP_FARTHEST_DISTANCE, "lookup_farthest_distance",
        "the focus distance is unknown: the falloff at the farthest stored distance is used"),
    ROW(LOOKUP_USUAL_DISTANCE, "lookup_usual_distance",
        "the focus distance is unknown: the mean falloff over usual distances is used"),
    ROW(LOOKUP_UNKNOWN_SENSOR, "lookup_unknown_sensor", "the sensor size is unknown: that of the profiles is used"),
    ROW(LOOKUP_ON_OTHER_CAMERA, "lookup_on_other_camera", "the falloff was measured on other cameras"),
    ROW(LOOKUP_TYPICAL_RESPONSE, "lookup_typical_response",
        "no response of this camera is stored: the typical one of its kind is used"),
    ROW(LOOKUP_OTHER_STYLE, "lookup_other_style", "the camera's response is stored for other picture styles only"),
    ROW(PRIOR_OVERRULED, "prior_overruled", "the prior profile contradicts the pictures and was left out"),
    ROW(PRIOR_RESPONSE_OVERRULED, "prior_response_overruled", "the prior response contradicts the pictures"),
    ROW(PRIOR_FALLOFF_OVERRULED, "prior_falloff_overruled", "the prior falloff contradicts the pictures"),
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
