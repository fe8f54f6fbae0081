#include "fit/verdict/reason.hpp"

#include "fit/base/fail.hpp"

namespace lensprof {
namespace {

// {item} is "image 3" or "shot 3"; {0} and {1} are the values, {0.2} with two decimals, {0.1%} a share as "3.4 %".
struct Wording {
    lensprof_reason code;
    const char *text;
};

constexpr Wording kWordings[] = {
    {LENSPROF_REASON_IMAGE_GROUPS,
     "the images form {0} groups: no usable overlap connects {item} to the reference, even through other images; more than half of the images must be consistent: add pictures that connect them, or check the alignment"},
    {LENSPROF_REASON_FEW_PAIRS,
     "{0} distinct pairs between black and white are too few for {1} unknowns; sample more pairs"},
    {LENSPROF_REASON_FEW_AGREE,
     "only {0%} of the pairs agree with one camera model; check the alignment of the pictures"},
    {LENSPROF_REASON_STILL_FEW_AGREE,
     "only {0%} of the pairs agree with one response; check that the pictures show one scene, that the camera did not move, and that their black level is 0"},
    {LENSPROF_REASON_SCATTER,
     "the pairs deviate by {0.1} levels from the best camera model; free more parameters, or check the alignment"},
    {LENSPROF_REASON_NOT_SETTLED,
     "the fit did not converge in {0} iterations; increase the limit, or sample more pairs"},
    {LENSPROF_REASON_FEW_BEHIND_EXPOSURE,
     "the exposure of {item} depends on only {0} pairs that agree with the camera model; increase its overlap, or check its alignment"},
    {LENSPROF_REASON_STILL_FEW_BEHIND_EXPOSURE,
     "the exposure of {item} depends on only {0} pairs that agree with the response; increase its overlap, or check whether something moved, the light changed, or its black level is raised"},
    {LENSPROF_REASON_IMAGE_DISAGREES,
     "only {0} of the {1} pairs of {item} agree with the camera model; check its alignment"},
    {LENSPROF_REASON_STILL_IMAGE_DISAGREES,
     "only {0} of the {1} pairs of {item} agree with the response; check whether something moved, the light changed, or its black level is raised"},
    {LENSPROF_REASON_PATTERNS,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which no response or falloff can explain: local tone mapping (HDR), or light that changed between the pictures"},
    {LENSPROF_REASON_PATTERNS_HELD,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which the response and falloff do not explain: free them if they are fixed; otherwise local tone mapping (HDR), or light that changed between the pictures"},
    {LENSPROF_REASON_STILL_PATTERNS,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which no response explains: the camera moved, the light changed, or local tone mapping (HDR); give plain exposures"},
    {LENSPROF_REASON_IMAGE_ODD,
     "most pairs of {item} disagree with the camera model (median residual {0.1} levels): check its alignment, and whether something moved"},
    {LENSPROF_REASON_STILL_IMAGE_ODD,
     "most pairs of {item} disagree with the response (median residual {0.1} levels): something moved, the light changed, or its black level is raised"},
    {LENSPROF_REASON_WEAK_PATTERNS,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which suggests weak local tone mapping (HDR): exposures may be less accurate than stated"},
    {LENSPROF_REASON_IMAGES_LEFT_OUT,
     "inconsistent images were left out ({0}, including {item}); check their alignment, or leave them out of the project"},
    {LENSPROF_REASON_IMAGES_UNCONNECTED,
     "no pairs connect {0} of the images, including {item}; add pictures that overlap them"},
    {LENSPROF_REASON_MANY_OUTLIERS,
     "{0%} of the pairs disagree with the camera model (residual {1.1} levels RMS): check the alignment, and whether something moved"},
    {LENSPROF_REASON_SEAMS_STAY,
     "overlapping pictures still differ by a median of {0.1} levels after correction ({1.1} before): check the alignment, and whether something moved"},
    {LENSPROF_REASON_LINKS_CONTRADICT,
     "{0} of the links between images, the first of {item}, contradict the others and were left out: check the alignment there, and whether something moved"},
    {LENSPROF_REASON_LINKS_UNVERIFIED,
     "{0} of the images, including {item}, overlap others only where there is too little texture to check the alignment: the alignment of the project is used there"},
    {LENSPROF_REASON_EXPOSURE_UNCERTAIN, "the exposure of {item} is uncertain by {0.1} EV; increase its overlap"},
    {LENSPROF_REASON_EXPOSURES_ALIKE,
     "the exposures of overlapping pictures differ by only {0.2} EV, too little to determine a response; take pictures with other exposures or, if the camera moved, use the method transfer"},
    {LENSPROF_REASON_KNOWN_ORDER,
     "the known exposures do not match the pictures, which differ by {0.1} EV; check their order, and that they belong to these pictures"},
    {LENSPROF_REASON_KNOWN_WRONG,
     "the exposure of {item} differs by {0.1} EV from the known one: one of the two is wrong, or the light changed"},
    {LENSPROF_REASON_KNOWN_MORE_FROM,
     "from {item} on, the known exposures are {0.1} EV higher than the pictures show: ISO, aperture or the light changed there unnoticed"},
    {LENSPROF_REASON_KNOWN_LESS_FROM,
     "from {item} on, the known exposures are {0.1} EV lower than the pictures show: ISO, aperture or the light changed there unnoticed"},
    {LENSPROF_REASON_KNOWN_CONTRADICT,
     "the known exposures contradict each other: one is wrong by more than {0.1} EV, but it is unclear which; gamma is uncertain accordingly. Check them, or take more pictures"},
    {LENSPROF_REASON_GAMMA_UNFOLLOWED,
     "the known exposures require all exposures to be {0.2} times as large, but the modes of the response do not allow it; exposures, falloff and response have a different exponent"},
    {LENSPROF_REASON_BALANCES_HELD,
     "the white balances are fixed, but the colours of {item} differ from those of its neighbours by {0.1} levels: free the white balances"},
    {LENSPROF_REASON_FEW_GREYS,
     "the pairs cover only {0} tenths of the grey values, too little to determine a response; take pictures with other exposures, or fix a known response"},
    {LENSPROF_REASON_MISSING_GREYS,
     "few pairs have grey values from {0.1} to {1.1} (of 1); there the response, and gamma, depend on the prior"},
    {LENSPROF_REASON_UNUSUAL_RESPONSE,
     "the response is unlike those of measured cameras of this kind ({0.1} times their spread from the mean), so gamma is uncertain by {1%}; choose another kind of camera, give known exposures that differ, or fix a known response"},
    {LENSPROF_REASON_RESPONSE_NOT_SHOWN,
     "the light differs by {0.2} EV between the pictures, too little or over too few grey values to determine a response: the prior response is used, and gamma is uncertain by {1%}; take pictures with other exposures"},
    {LENSPROF_REASON_SMALL_RADIUS,
     "the pairs reach only to {0.1} of the half diagonal, which does not determine the falloff in the corners; increase the overlap of the pictures, or fix the falloff"},
    {LENSPROF_REASON_CORNER_UNCERTAIN,
     "the falloff in the corners is uncertain by {0%}; sample more pairs, or increase the overlap"},
    {LENSPROF_REASON_SAME_VIEW, "the pictures show almost the same view (r^2 changes by {0.3} between them), which determines no falloff; take pictures that overlap by half, or use bracket or align for plain exposures (no HDR) from a tripod"},
    {LENSPROF_REASON_EXPOSURES_ONLY,
     "response and falloff predict held-out pairs no better than exposures and white balances alone; give pictures with larger overlaps or other exposures"},
    {LENSPROF_REASON_NOTHING_BETTER,
     "no correction makes held-out pairs differ less than the pictures as they are: these match already, or differ by more than a camera does"},
    {LENSPROF_REASON_NOT_RADIAL,
     "{0%} of the residual follows one pattern over the frame ({1.1} levels): the falloff is not radial"},
    {LENSPROF_REASON_FALLOFF_RISES,
     "the falloff rises to {0%} of the light in the middle (+- {1%}), unlike any lens: negatives, misaligned pictures, or light that differs across the scene; correct the alignment, or fix the falloff"},
    {LENSPROF_REASON_FALLOFF_DARK,
     "the falloff leaves {0.1%} of the light at the edge, unlike any lens: grey values stretched or equalised in every picture, or a lens hood in the corners; give unprocessed pictures of the camera, or exclude the corners"},
    {LENSPROF_REASON_CENTER_ON_LIMIT,
     "the centre of the falloff is on its limit, {0.2} half diagonals from the middle of the frame: the pairs do not determine it; fix the centre"},
    {LENSPROF_REASON_FALLOFF_RISES_SOME,
     "the falloff rises to {0%} of the light in the middle (+- {1%}): the camera may have corrected it already"},
    {LENSPROF_REASON_FAR_CENTER,
     "the centre of the falloff lies {0.2} half diagonals from the middle of the frame; check whether the pictures are cropped, and their alignment"},
    {LENSPROF_REASON_FLAT_WHITE, "{0%} of the card in {item} is white in every exposure; take a shorter exposure"},
    {LENSPROF_REASON_FLAT_BLACK, "{0%} of the card in {item} is black in every exposure; take a longer exposure"},
    {LENSPROF_REASON_FLAT_NO_CARD,
     "no card was found in {item}: no even bright region is larger than a hundredth of the frame; specify where it is, or light the whole frame evenly"},
    {LENSPROF_REASON_FLAT_FEW_CELLS,
     "{0} cells of even light are too few; use larger pictures, or show more of the card"},
    {LENSPROF_REASON_FLAT_SMALL_RADIUS,
     "the card reaches only to {0.2} of the half diagonal, which does not determine the falloff in the corners; add pictures with the card in the corners"},
    {LENSPROF_REASON_FLAT_RESPONSE_STEP,
     "the given response is a step at the grey values of {item}, which therefore do not determine the light; give the camera's own response, or another exposure"},
    {LENSPROF_REASON_FLAT_RESPONSE_LEVEL,
     "the given response is flat at the grey values of {item}, which therefore do not determine the light; give the camera's own response, or another exposure"},
    {LENSPROF_REASON_FLAT_EXPOSURE_WRONG,
     "{item} is {0.2} EV away from the others of its shot: the given exposures or response are wrong, or the light changed"},
    {LENSPROF_REASON_FLAT_TEXTURE,
     "the card is not uniform: it has texture of {0.1%} above the noise; defocus, come closer, or use a diffuser"},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER,
     "the shots differ by {0.1%} in ways that one lens and one light do not explain: the light changed, a shadow fell on the card, or the angles of the rotated shots are wrong"},
    {LENSPROF_REASON_FLAT_FEW_AGREE,
     "only {0%} of the cells agree with one falloff and one light; check that the light is even"},
    {LENSPROF_REASON_FLAT_STEEP,
     "the light of {item} varies by {0%} per half diagonal, which a plane does not describe; even it out"},
    {LENSPROF_REASON_FLAT_STEEP_ALONE,
     "the light of {item} varies by {0%} per half diagonal; without a rotated shot it cannot be separated from the lens; even it out, or add a shot with the camera rotated by 90 or 180 degrees"},
    {LENSPROF_REASON_FLAT_CORNER_NOT_RADIAL,
     "{0.1%} of the light is not radial, which leaves the falloff in the corners uncertain by {1.1%}; request a gain grid"},
    {LENSPROF_REASON_FLAT_CORNER_UNCERTAIN,
     "the falloff in the corners is uncertain by {0.1%}: too noisy, or the card is not visible there; average more pictures, or add some with the card in the corners"},
    {LENSPROF_REASON_FLAT_EXTRAPOLATED,
     "the card reaches to {0.2} of the half diagonal: the falloff in the corners is extrapolated"},
    {LENSPROF_REASON_FLAT_SOME_WHITE, "{0.1%} of the card in {item} is white in every exposure and was left out"},
    {LENSPROF_REASON_FLAT_SOME_BLACK, "{0.1%} of the card in {item} is black in every exposure and was left out"},
    {LENSPROF_REASON_FLAT_EXPOSURE_DOUBTFUL,
     "{item} is {0.2} EV away from the others of its shot: the given exposures or response are slightly wrong"},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER_SOME,
     "the shots differ by {0.1%} in ways that one lens and one light do not explain"},
    {LENSPROF_REASON_FLAT_SOME_TEXTURE, "the card has texture of {0.1%} above the noise; defocus or use a diffuser"},
    {LENSPROF_REASON_FLAT_SLANTED_LIGHT,
     "the light varies by {0%} per half diagonal; without a rotated shot it cannot be separated from the lens: the centre depends on its prior; add a shot with the camera rotated by 90 or 180 degrees"},
    {LENSPROF_REASON_FLAT_NOT_RADIAL_GRID,
     "{0.1%} of the light is not radial: the gain grid describes it, except for {1.1%}"},
    {LENSPROF_REASON_FLAT_NOT_RADIAL, "{0.1%} of the light is not radial; request a gain grid"},
    {LENSPROF_REASON_FLAT_FAR_CENTER,
     "the centre of the falloff lies {0.2} half diagonals from the middle of the frame; check whether the pictures are cropped or the light is uneven"},
    {LENSPROF_REASON_FLAT_DUST, "{0} spots of dust were left out"},
    {LENSPROF_REASON_PRIOR_OVERRULED,
     "the profile given as the prior contradicts the pictures (it is off by {0.1}, held-out pairs by {1.1} standard errors) and was rejected; check that it is for this lens and setting"},
    {LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED,
     "the response of the profile given as the prior contradicts the pictures (its shape is off by {0.1}, held-out pairs by {1.1} standard errors) and was rejected; its falloff was used"},
    {LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED,
     "the falloff of the profile given as the prior contradicts the pictures (it is off by {0.1}, held-out pairs by {1.1} standard errors) and was rejected; its response was used"},
};

std::string wording_of(lensprof_reason code) {
    for (const Wording &wording : kWordings)
        if (wording.code == code) return wording.text;
    return lensprof_reason_text(code);
}

// The value for a placeholder such as "0.1%".
std::string spell_value(const std::string &place, const std::vector<double> &values) {
    const auto index = static_cast<size_t>(place[0] - '0');
    const size_t point = place.find('.');
    const int decimals = point == std::string::npos ? 0 : place[point + 1] - '0';
    const bool is_share = place.back() == '%';
    char text[64];
    std::snprintf(text, sizeof text, is_share ? "%.*f %%" : "%.*f", decimals, (is_share ? 100.0 : 1.0) * values[index]);
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
    for (size_t position = 0; position < wording.size();) {
        if (wording[position] != '{') {
            sentence.text += wording[position++];
            continue;
        }
        const size_t end = wording.find('}', position);
        const std::string place = wording.substr(position + 1, end - position - 1);
        const size_t begin = sentence.text.size();
        if (place == "item") {
            sentence.text += item_word(reason.kind) + (" " + std::to_string(reason.index));
            sentence.item.text_begin = static_cast<uint32_t>(begin);
            sentence.item.text_bytes = static_cast<uint32_t>(sentence.text.size() - begin);
        } else {
            sentence.text += spell_value(place, reason.values);
        }
        position = end + 1;
    }
    return sentence;
}

}  // namespace lensprof
