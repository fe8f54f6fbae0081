#include "fit/verdict/reason.hpp"

#include "fit/base/fail.hpp"

namespace lensprof {
namespace {

// {item} is "image 3" or "shot 3"; {0} and {1} are the values, {0.2} with two decimals, {0.1%} a share as "3.4 %".
struct Wording {
    lensprof_reason code;
    const char *text;
};

constexpr Wording
    kWordings[] =
        {
            {LENSPROF_REASON_IMAGE_GROUPS,
             "the images fall into {0} groups: no usable overlap joins {item} to the reference, not even through others; more than half of the images must agree: add pictures that join them, or check the alignment"},
            {LENSPROF_REASON_FEW_PAIRS,
             "{0} different pairs between black and white are too few for {1} unknowns; sample more"},
            {LENSPROF_REASON_FEW_AGREE,
             "only {0%} of the pairs agree with one camera model; check the alignment of the pictures"},
            {LENSPROF_REASON_STILL_FEW_AGREE,
             "only {0%} of the pairs agree with one response; are the pictures of one scene, by a camera that did not move, and is their black 0?"},
            {LENSPROF_REASON_SCATTER,
             "the pairs scatter by {0.1} levels about the best camera model; free more parameters, or check the alignment"},
            {LENSPROF_REASON_NOT_SETTLED, "the fit did not settle in {0} iterations"},
            {LENSPROF_REASON_FEW_BEHIND_EXPOSURE,
             "the exposure of {item} rests on {0} pairs that agree with the camera model; overlap it more, or check its alignment"},
            {LENSPROF_REASON_STILL_FEW_BEHIND_EXPOSURE,
             "the exposure of {item} rests on {0} pairs that agree with the camera model; overlap it more, or something moved, its light changed, or its black is raised"},
            {LENSPROF_REASON_IMAGE_DISAGREES,
             "only {0} of the {1} pairs of {item} agree with the camera model; check its alignment"},
            {LENSPROF_REASON_STILL_IMAGE_DISAGREES,
             "only {0} of the {1} pairs of {item} agree with the camera model; something moved, its light changed, or its black is raised"},
            {LENSPROF_REASON_PATTERNS,
             "{0%} of the residual follows patterns of each image's own ({1.1} levels), which no response and falloff explain: local tone mapping (HDR), or light that changed between the pictures"},
            {LENSPROF_REASON_PATTERNS_HELD,
             "{0%} of the residual follows patterns of each image's own ({1.1} levels), which the response or falloff that are held do not explain; free them"},
            {LENSPROF_REASON_STILL_PATTERNS,
             "{0%} of the residual follows patterns of each image's own ({1.1} levels), which no response explains: the camera moved, the light changed between the pictures, or local tone mapping (HDR)"},
            {LENSPROF_REASON_IMAGE_ODD,
             "most pairs of {item} disagree with the camera model (median residual {0.1} levels): check its alignment, or what moved there"},
            {LENSPROF_REASON_STILL_IMAGE_ODD,
             "most pairs of {item} disagree with the camera model (median residual {0.1} levels): something moved, its light changed, or its black is raised"},
            {LENSPROF_REASON_WEAK_PATTERNS,
             "{0%} of the residual follows patterns of each image's own ({1.1} levels), as weak local tone mapping (HDR) makes them: exposures may be farther off than stated"},
            {LENSPROF_REASON_IMAGES_LEFT_OUT,
             "images that do not agree with the others were left out ({0}, {item} among them); check their alignment, or leave them out of the project"},
            {LENSPROF_REASON_MANY_OUTLIERS,
             "{0%} of the pairs disagree with the camera model (residual {1.1} levels RMS): check the alignment, or what moved"},
            {LENSPROF_REASON_SEAMS_STAY,
             "pictures that overlap still differ by {0.1} levels after correction, and by {1.1} before, in the median: check the alignment, or what moved"},
            {LENSPROF_REASON_LINKS_CONTRADICT,
             "{0} of the links between images, the first of {item}, contradict the others and were left out: check the alignment there, or what moved"},
            {LENSPROF_REASON_LINKS_UNVERIFIED,
             "{0} of the images, {item} among them, overlap others only where there is too little texture to check the alignment: the project is taken at its word there"},
            {LENSPROF_REASON_EXPOSURE_UNCERTAIN,
             "the pairs leave the exposure of {item} uncertain by {0.1} EV; overlap it more"},
            {LENSPROF_REASON_KNOWN_ALIKE,
             "the known exposures of pictures that overlap differ by {0.2} EV, which shows no response; take pictures of other exposures, or use the method transfer"},
            {LENSPROF_REASON_EXPOSURES_ALIKE,
             "the pictures that overlap differ by {0.2} EV, which shows no response; take pictures of other exposures, or, where the camera moved, use the method transfer"},
            {LENSPROF_REASON_KNOWN_ORDER,
             "the known exposures do not follow the pictures, which differ by {0.1} EV: are they in another order, or of other pictures?"},
            {LENSPROF_REASON_KNOWN_WRONG,
             "the exposure of {item} is {0.1} EV away from its known one: one of the two is wrong, or its light changed"},
            {LENSPROF_REASON_KNOWN_MORE_FROM,
             "from {item} on the known exposures are {0.1} EV more than the pictures: ISO, aperture or the light changed there unnoticed"},
            {LENSPROF_REASON_KNOWN_LESS_FROM,
             "from {item} on the known exposures are {0.1} EV less than the pictures: ISO, aperture or the light changed there unnoticed"},
            {LENSPROF_REASON_KNOWN_CONTRADICT,
             "the known exposures contradict each other: one is wrong by more than {0.1} EV, and they do not tell which; gamma is as uncertain. Check them, or take more pictures"},
            {LENSPROF_REASON_GAMMA_UNFOLLOWED,
             "the known exposures call for all exposures {0.2} times as large: the modes of the response cannot follow there; exposures, falloff and response have another exponent than what is known"},
            {LENSPROF_REASON_BALANCES_HELD,
             "the white balances are held, but the colours of {item} differ from those of its neighbours by {0.1} levels: free the white balances"},
            {LENSPROF_REASON_FEW_GREYS,
             "the pairs cover {0} tenths of the grey values only, which does not show a response; take pictures of other exposures, or hold a response that is known"},
            {LENSPROF_REASON_MISSING_GREYS,
             "hardly a pair has grey values from {0.1} to {1.1} (of 1): what is said of the response there, and of gamma, rests on the prior"},
            {LENSPROF_REASON_UNUSUAL_RESPONSE,
             "the response is unlike those of measured cameras of this kind ({0.1} times as far from their mean as these keep), so that gamma is uncertain by {1%}; say another kind of camera, give known exposures that differ, or hold a response that is known"},
            {LENSPROF_REASON_RESPONSE_NOT_SHOWN,
             "the light differs by {0.2} EV between the pictures, by too little or over too few grey values to show a response: it is held at the one known before, and gamma is uncertain by {1%}; take pictures of other exposures"},
            {LENSPROF_REASON_SMALL_RADIUS,
             "the pairs reach to {0.1} of the half diagonal only, which does not show the falloff in the corners; overlap the pictures more, or fix the falloff"},
            {LENSPROF_REASON_CORNER_UNCERTAIN,
             "the pairs leave the falloff in the corners uncertain by {0%}; sample more, or overlap more"},
            {LENSPROF_REASON_NOT_RADIAL,
             "{0%} of the residual follows one pattern over the frame ({1.1} levels): the falloff is not radial"},
            {LENSPROF_REASON_FALLOFF_RISES,
             "the falloff rises to {0%} of the light in the middle (+- {1%}), as of no lens: negatives, pictures that are off their places, or light that differs from one side of the scene to the other; correct the alignment, or hold the falloff"},
            {LENSPROF_REASON_FALLOFF_DARK,
             "the falloff leaves {0.1%} of the light at the edge, as of no lens: grey values that were stretched or equalised in every picture, or a lens hood in the corners; give the camera's own pictures, or exclude the corners"},
            {LENSPROF_REASON_CENTER_ON_LIMIT,
             "the centre of the falloff is on its limit, {0.2} half diagonals from the middle of the frame: the pairs do not show it; hold the centre"},
            {LENSPROF_REASON_FALLOFF_RISES_SOME,
             "the falloff rises to {0%} of the light in the middle (+- {1%}): the camera may have corrected it already"},
            {LENSPROF_REASON_FAR_CENTER,
             "the centre of the falloff lies {0.2} half diagonals from the middle of the frame: are the pictures cropped, or is their alignment wrong?"},
            {LENSPROF_REASON_FLAT_WHITE,
             "{0%} of the card in {item} is white in every exposure; take a shorter exposure"},
            {LENSPROF_REASON_FLAT_BLACK,
             "{0%} of the card in {item} is black in every exposure; take a longer exposure"},
            {LENSPROF_REASON_FLAT_NO_CARD,
             "no card was found in {item}: no even bright region is larger than a hundredth of the frame; say where it is, or use an even light over the whole frame"},
            {LENSPROF_REASON_FLAT_FEW_CELLS,
             "{0} cells of even light are too few; use larger pictures, or more of the card"},
            {LENSPROF_REASON_FLAT_SMALL_RADIUS,
             "the card reaches to {0.2} of the half diagonal only, which does not show the falloff in the corners; add pictures with the card in the corners"},
            {LENSPROF_REASON_FLAT_RESPONSE_STEP,
             "the response given is a step where the grey values of {item} lie, so that these do not determine the light; give the camera's own response, or another exposure"},
            {LENSPROF_REASON_FLAT_RESPONSE_LEVEL,
             "the response given is flat where the grey values of {item} lie, so that these do not determine the light; give the camera's own response, or another exposure"},
            {LENSPROF_REASON_FLAT_EXPOSURE_WRONG,
             "{item} is {0.2} EV away from the others of its shot: the exposures, or the response, are not what was said, or the light changed"},
            {LENSPROF_REASON_FLAT_TEXTURE,
             "the card is not even: it has texture of {0.1%} beyond the noise; defocus, come closer, or use a diffuser"},
            {LENSPROF_REASON_FLAT_SHOTS_DIFFER,
             "the shots differ by {0.1%} in ways that one lens and one light do not explain: the light changed, a shadow fell on the card, or the angles of the turned shots are wrong"},
            {LENSPROF_REASON_FLAT_FEW_AGREE,
             "only {0%} of the cells agree with one falloff and one light; is it an even light?"},
            {LENSPROF_REASON_FLAT_STEEP,
             "the light of {item} changes by {0%} a half diagonal, which a plane does not describe; even it out"},
            {LENSPROF_REASON_FLAT_STEEP_ALONE,
             "the light of {item} changes by {0%} a half diagonal, and no turned shot tells it from the lens; even it out, or add a shot with the camera turned by 90 or 180 degrees"},
            {LENSPROF_REASON_FLAT_CORNER_NOT_RADIAL,
             "{0.1%} of the light is not radial, which leaves the falloff in the corners uncertain by {1.1%}; ask for a gain grid"},
            {LENSPROF_REASON_FLAT_CORNER_UNCERTAIN,
             "the falloff in the corners is uncertain by {0.1%}: too noisy, or the card is not seen there; average more pictures, or add some with the card in the corners"},
            {LENSPROF_REASON_FLAT_EXTRAPOLATED,
             "the card reaches to {0.2} of the half diagonal: the falloff in the corners is extrapolated"},
            {LENSPROF_REASON_FLAT_SOME_WHITE,
             "{0.1%} of the card in {item} is white in every exposure and was left out"},
            {LENSPROF_REASON_FLAT_SOME_BLACK,
             "{0.1%} of the card in {item} is black in every exposure and was left out"},
            {LENSPROF_REASON_FLAT_EXPOSURE_DOUBTFUL,
             "{item} is {0.2} EV away from the others of its shot: exposures or response are not quite what was said"},
            {LENSPROF_REASON_FLAT_SHOTS_DIFFER_SOME,
             "the shots differ by {0.1%} in ways that one lens and one light do not explain"},
            {LENSPROF_REASON_FLAT_SOME_TEXTURE,
             "the card has texture of {0.1%} beyond the noise; defocus or use a diffuser"},
            {LENSPROF_REASON_FLAT_SLANTED_LIGHT,
             "the light changes by {0%} a half diagonal and no turned shot tells it from the lens: the centre rests on its prior; add a shot with the camera turned by 90 or 180 degrees"},
            {LENSPROF_REASON_FLAT_NOT_RADIAL_GRID,
             "{0.1%} of the light is not radial: the gain grid takes it, and leaves {1.1%}"},
            {LENSPROF_REASON_FLAT_NOT_RADIAL, "{0.1%} of the light is not radial; ask for a gain grid"},
            {LENSPROF_REASON_FLAT_FAR_CENTER,
             "the centre of the falloff lies {0.2} half diagonals from the middle of the frame: are the pictures cropped, or is the light not even?"},
            {LENSPROF_REASON_FLAT_DUST, "{0} spots of dust were left out"},
            {LENSPROF_REASON_PRIOR_OVERRULED,
             "the profile given as the prior contradicts the pictures (it is {0.1}, held-out pairs {1.1} standard errors off) and was left out: is it of this lens and setting?"},
            {LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED,
             "the response of the profile given as the prior contradicts the pictures (its shape is {0.1}, held-out pairs {1.1} standard errors off) and was left out; its falloff was used"},
            {LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED,
             "the falloff of the profile given as the prior contradicts the pictures (it is {0.1}, held-out pairs {1.1} standard errors off) and was left out; its response was used"},
};

std::string wording_of(lensprof_reason code) {
    for (const Wording &wording : kWordings)
        if (wording.code == code) return wording.text;
    return lensprof_reason_text(code);
}

// The value that a place "0.1%" stands for.
std::string spell_value(const std::string &place, const std::vector<double> &values) {
    const auto which = static_cast<size_t>(place[0] - '0');
    const size_t point = place.find('.');
    const int decimals = point == std::string::npos ? 0 : place[point + 1] - '0';
    const bool is_share = place.back() == '%';
    char text[64];
    std::snprintf(text, sizeof text, is_share ? "%.*f %%" : "%.*f", decimals, (is_share ? 100.0 : 1.0) * values[which]);
    return text;
}

}  // namespace

Reason of_image(lensprof_reason code, uint32_t index, std::vector<double> values) {
    return {code, std::move(values), LENSPROF_ITEM_IMAGE, index};
}

Reason of_shot(lensprof_reason code, uint32_t number, std::vector<double> values) {
    return {code, std::move(values), LENSPROF_ITEM_SHOT, number};
}

Sentence sentence_of(const Reason &reason) {
    const std::string wording = wording_of(reason.code);
    Sentence sentence{{}, {static_cast<uint32_t>(reason.kind), reason.index, 0, 0}};
    for (size_t at = 0; at < wording.size();) {
        if (wording[at] != '{') {
            sentence.text += wording[at++];
            continue;
        }
        const size_t end = wording.find('}', at);
        const std::string place = wording.substr(at + 1, end - at - 1);
        const size_t begin = sentence.text.size();
        if (place == "item") {
            sentence.text += item_word(reason.kind) + (" " + std::to_string(reason.index));
            sentence.item.text_begin = static_cast<uint32_t>(begin);
            sentence.item.text_bytes = static_cast<uint32_t>(sentence.text.size() - begin);
        } else {
            sentence.text += spell_value(place, reason.values);
        }
        at = end + 1;
    }
    return sentence;
}

}  // namespace lensprof
