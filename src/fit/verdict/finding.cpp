#include "fit/verdict/finding.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string>

#include "fit/base/fail.hpp"

namespace lensprof {
namespace {

// {item} is "image 3" or "shot 3"; {0} and {1} are the values, {0.2} with two decimals, {|0.2} without its sign, {0.1%}
// a share as "3.4 %", {0.2e} a share as "0.05 EV".
struct Sentence {
    lensprof_reason code;
    Wording wording;
    const char *text;
};

// clang-format off
constexpr Sentence kSentences[] = {
    {LENSPROF_REASON_IMAGE_GROUPS, Wording::usual,
     "the images form {0} groups: no usable overlap connects {item} to the reference, even through other images; more than half of the images must be consistent: add pictures that connect them, or check the alignment"},
    {LENSPROF_REASON_IMAGE_GROUPS, Wording::light,
     "{0} of the images, the first of them {item}, show the scene in different light from the rest (colours differ {1} times as much between these groups as within): fit each visit separately"},
    {LENSPROF_REASON_FEW_PAIRS, Wording::usual,
     "{0} distinct pairs between black and white are too few for {1} unknowns; sample more pairs"},
    {LENSPROF_REASON_FEW_AGREE, Wording::usual,
     "only {0%} of the pairs agree with one camera model; check the alignment of the pictures"},
    {LENSPROF_REASON_FEW_AGREE, Wording::still,
     "only {0%} of the pairs agree with one response; check that the pictures show one scene, that the camera did not move, and that their black level is 0"},
    {LENSPROF_REASON_FEW_AGREE, Wording::card,
     "only {0%} of the cells agree with one falloff and one light; check that the light is even"},
    {LENSPROF_REASON_SCATTER, Wording::usual,
     "the pairs deviate by {0.1} levels from the best camera model; free more parameters, or check the alignment"},
    {LENSPROF_REASON_NOT_CONVERGED, Wording::usual,
     "the fit did not converge in {0} iterations; increase the limit, or sample more pairs"},
    {LENSPROF_REASON_FEW_INLIERS, Wording::usual,
     "the exposure of {item} depends on only {0} pairs that agree with the camera model; increase its overlap, or check its alignment"},
    {LENSPROF_REASON_FEW_INLIERS, Wording::still,
     "the exposure of {item} depends on only {0} pairs that agree with the response; increase its overlap, or check whether something moved, the light changed, or its black level is raised"},
    {LENSPROF_REASON_IMAGE_DISAGREES, Wording::usual,
     "only {0} of the {1} pairs of {item} agree with the camera model; check its alignment"},
    {LENSPROF_REASON_IMAGE_DISAGREES, Wording::still,
     "only {0} of the {1} pairs of {item} agree with the response; check whether something moved, the light changed, or its black level is raised"},
    {LENSPROF_REASON_PATTERNS, Wording::usual,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which no response or falloff can explain: local tone mapping (HDR), or light that changed between the pictures"},
    {LENSPROF_REASON_PATTERNS, Wording::held,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which the response and falloff do not explain: free them if they are fixed; otherwise local tone mapping (HDR), or light that changed between the pictures"},
    {LENSPROF_REASON_PATTERNS, Wording::still,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which no response explains: the camera moved, the light changed, or local tone mapping (HDR); give plain exposures"},
    {LENSPROF_REASON_PATTERNS, Wording::odd,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), and the response is unlike those of measured cameras: negatives, local tone mapping (HDR), or pictures that are misplaced; check the alignment, and give unprocessed pictures"},
    {LENSPROF_REASON_PATTERNS, Wording::weak,
     "{0%} of the residual follows a different pattern in each image ({1.1} levels), which suggests weak local tone mapping (HDR): exposures may be less accurate than stated"},
    {LENSPROF_REASON_IMAGE_INCONSISTENT, Wording::usual,
     "most pairs of {item} disagree with the camera model (median residual {0.1} levels): check its alignment, and whether something moved"},
    {LENSPROF_REASON_IMAGE_INCONSISTENT, Wording::still,
     "most pairs of {item} disagree with the response (median residual {0.1} levels): something moved, the light changed, or its black level is raised"},
    {LENSPROF_REASON_IMAGES_LEFT_OUT, Wording::usual,
     "inconsistent images were left out ({0}, including {item}); check their alignment, or leave them out of the project"},
    {LENSPROF_REASON_IMAGES_UNCONNECTED, Wording::usual,
     "no pairs connect {0} of the images, including {item}; add pictures that overlap them"},
    {LENSPROF_REASON_IMAGES_MINORITY, Wording::usual,
     "only {0} of {1} images take part in the result, and none of their overlaps shows the same content: give pictures that overlap by a third"},
    {LENSPROF_REASON_MANY_OUTLIERS, Wording::usual,
     "{0%} of the pairs disagree with the camera model (residual {1.1} levels RMS): check the alignment, and whether something moved"},
    {LENSPROF_REASON_SEAMS_REMAIN, Wording::usual,
     "overlapping pictures still differ by a median of {0.1} levels after correction ({1.1} before): check the alignment, and whether something moved"},
    {LENSPROF_REASON_SEAMS_REMAIN, Wording::still,
     "the pictures still differ by a median of {0.1} levels after correction ({1.1} before): something moved, the light changed, or black is raised; give the black level, or leave out the darkest pictures"},
    {LENSPROF_REASON_LINKS_CONTRADICT, Wording::usual,
     "{0} of the links between images, the first of {item}, contradict the others and were left out: check the alignment there, and whether something moved"},
    {LENSPROF_REASON_LINKS_UNVERIFIED, Wording::usual,
     "{0} of the images, including {item}, overlap others only where there is too little texture to check the alignment: the alignment of the project is used there"},
    {LENSPROF_REASON_EXPOSURE_UNCERTAIN, Wording::usual,
     "the exposure of {item} is uncertain by {0.1} EV; increase its overlap"},
    {LENSPROF_REASON_EXPOSURES_EQUAL, Wording::usual,
     "the exposures of overlapping pictures differ by only {0.2} EV, too little to determine a response; take pictures with other exposures or, if the camera moved, use the method transfer"},
    {LENSPROF_REASON_KNOWN_ORDER, Wording::usual,
     "the known exposures do not match the pictures, which differ by {0.1} EV; check their order, and that they belong to these pictures"},
    {LENSPROF_REASON_KNOWN_WRONG, Wording::usual,
     "the exposure of {item} differs by {|0.1} EV from the known one: one of the two is wrong, or the light changed"},
    {LENSPROF_REASON_KNOWN_STEP, Wording::usual,
     "from {item} on, the known exposures are {|0.1} EV higher than the pictures show: ISO, aperture or the light changed there unnoticed"},
    {LENSPROF_REASON_KNOWN_STEP, Wording::less,
     "from {item} on, the known exposures are {|0.1} EV lower than the pictures show: ISO, aperture or the light changed there unnoticed"},
    {LENSPROF_REASON_KNOWN_CONTRADICT, Wording::usual,
     "the known exposures contradict each other: one is wrong by more than {0.1} EV, but it is unclear which; gamma is uncertain accordingly. Check them, omit them, or take more pictures"},
    {LENSPROF_REASON_GAMMA_INCONSISTENT, Wording::usual,
     "the known exposures require all exposures to be {0.2} times as large, but the modes of the response do not allow it; exposures, falloff and response have a different exponent"},
    {LENSPROF_REASON_WHITE_BALANCE_FIXED, Wording::usual,
     "the white balances are fixed, but the colours of {item} differ from those of its neighbours by {0.1} levels: free the white balances"},
    {LENSPROF_REASON_FEW_GREYS, Wording::usual,
     "the pairs cover only {0} tenths of the grey values, too little to determine a response; take pictures with other exposures, or fix a known response"},
    {LENSPROF_REASON_MISSING_GREYS, Wording::usual,
     "few pairs have grey values from {0.1} to {1.1} (of 1); there the response, and gamma, depend on the prior"},
    {LENSPROF_REASON_UNUSUAL_RESPONSE, Wording::usual,
     "the response is unlike those of measured cameras of this kind ({0.1} times their spread from the mean), so gamma is uncertain by {1%}; choose another kind of camera, give known exposures that differ, or fix a known response"},
    {LENSPROF_REASON_RESPONSE_UNCONSTRAINED, Wording::usual,
     "the light differs by {0.2} EV between the pictures, too little or over too few grey values to determine a response: the prior response is used, and gamma is uncertain by {1%}; take pictures with other exposures"},
    {LENSPROF_REASON_SMALL_RADIUS, Wording::usual,
     "the pairs reach only to {0.1} of the half diagonal, which does not determine the falloff in the corners; increase the overlap of the pictures, or fix the falloff"},
    {LENSPROF_REASON_SMALL_RADIUS, Wording::card,
     "the card reaches only to {0.2} of the half diagonal, which does not determine the falloff in the corners; add pictures with the card in the corners"},
    {LENSPROF_REASON_SMALL_RADIUS, Wording::weak,
     "the card reaches to {0.2} of the half diagonal: the falloff in the corners is extrapolated"},
    {LENSPROF_REASON_CORNER_UNCERTAIN, Wording::usual,
     "the falloff in the corners is uncertain by {0%}; sample more pairs, or increase the overlap"},
    {LENSPROF_REASON_CORNER_UNCERTAIN, Wording::alone,
     "{1.1%} of the light is not radial, which leaves the falloff in the corners uncertain by {0.1%}; show the card at three different angles of the camera; if the lens is the cause, request a gain grid"},
    {LENSPROF_REASON_CORNER_UNCERTAIN, Wording::grid,
     "{1.1%} of the light is not radial, which leaves the falloff in the corners uncertain by {0.1%}; request a gain grid"},
    {LENSPROF_REASON_CORNER_UNCERTAIN, Wording::card,
     "the falloff in the corners is uncertain by {0.1%}: too noisy, or the card is not visible there; average more pictures, or add some with the card in the corners"},
    {LENSPROF_REASON_SAME_VIEW, Wording::usual,
     "the pictures show almost the same view (r^2 changes by {0.3} between them), which determines no falloff; take pictures that overlap by half, or use bracket or align for plain exposures (no HDR) from a tripod"},
    {LENSPROF_REASON_EXPOSURES_ONLY, Wording::usual,
     "response and falloff predict the pairs no better than exposures and white balances alone; give pictures with larger overlaps or other exposures"},
    {LENSPROF_REASON_NOTHING_BETTER, Wording::usual,
     "no correction makes the pairs differ less than the pictures as they are: these match already, or differ by more than a camera does"},
    {LENSPROF_REASON_NOT_RADIAL, Wording::usual,
     "{0%} of the residual follows one pattern over the frame ({1.1} levels): the falloff is not radial; a card gives a gain grid"},
    {LENSPROF_REASON_FALLOFF_RISES, Wording::usual,
     "the falloff rises to {0%} of the light in the middle (+- {1%}), unlike any lens: negatives, misaligned pictures, or light that differs across the scene; correct the alignment, or fix the falloff"},
    {LENSPROF_REASON_FALLOFF_RISES, Wording::weak,
     "the falloff rises to {0%} of the light in the middle (+- {1%}): the camera may have corrected it already"},
    {LENSPROF_REASON_FALLOFF_DARK, Wording::usual,
     "the falloff leaves {0.1%} of the light at the edge, unlike any lens: grey values stretched or equalised in every picture, or a lens hood in the corners; give unprocessed pictures of the camera, or exclude the corners"},
    {LENSPROF_REASON_CENTER_ON_LIMIT, Wording::usual,
     "the centre of the falloff is on its limit, {0.2} half diagonals from the middle of the frame: the pairs do not determine it; fix the centre"},
    {LENSPROF_REASON_FAR_CENTER, Wording::usual,
     "the centre of the falloff lies {0.2} half diagonals from the middle of the frame; check whether the pictures are cropped, and their alignment"},
    {LENSPROF_REASON_FAR_CENTER, Wording::card,
     "the centre of the falloff lies {0.2} half diagonals from the middle of the frame; check whether the pictures are cropped or the light is uneven"},
    {LENSPROF_REASON_FEW_IMAGES, Wording::usual,
     "the falloff is from only {0} images of a moving camera, in which objects that look different from another side resemble falloff; it may be off by twice the stated error: give {1} images or more"},
    {LENSPROF_REASON_FLAT_WHITE, Wording::usual,
     "{0%} of the card in {item} is white in every exposure; take a shorter exposure"},
    {LENSPROF_REASON_FLAT_WHITE, Wording::weak,
     "{0.1%} of the card in {item} is white in every exposure and was left out, about {1.2},{2.2} half diagonals from the middle; the falloff in the corners is then known to +- {3.2%}"},
    {LENSPROF_REASON_FLAT_BLACK, Wording::usual,
     "{0%} of the card in {item} is black in every exposure; take a longer exposure"},
    {LENSPROF_REASON_FLAT_BLACK, Wording::weak,
     "{0.1%} of the card in {item} is black in every exposure and was left out, about {1.2},{2.2} half diagonals from the middle; the falloff in the corners is then known to +- {3.2%}"},
    {LENSPROF_REASON_FLAT_NO_CARD, Wording::usual,
     "no card was found in {item}: no even bright region is larger than a hundredth of the frame; specify where it is, or light the whole frame evenly"},
    {LENSPROF_REASON_FLAT_FEW_CELLS, Wording::usual,
     "{0} cells of even light are too few; use larger pictures, or show more of the card"},
    {LENSPROF_REASON_FLAT_RESPONSE, Wording::less,
     "the given response is a step at the grey values of {item}, which therefore do not determine the light; give the camera's own response, or another exposure"},
    {LENSPROF_REASON_FLAT_RESPONSE, Wording::usual,
     "the given response is flat at the grey values of {item}, which therefore do not determine the light; give the camera's own response, or another exposure"},
    {LENSPROF_REASON_FLAT_EXPOSURE_WRONG, Wording::usual,
     "{item} is {0.2} EV away from the others of its shot: the given exposures or response are wrong, or the light changed"},
    {LENSPROF_REASON_FLAT_EXPOSURE_WRONG, Wording::weak,
     "{item} is {0.2} EV away from the others of its shot: the given exposures or response are slightly wrong"},
    {LENSPROF_REASON_FLAT_TEXTURE, Wording::usual,
     "the card is not uniform: it has texture of {0.1%} above the noise, which leaves the falloff in the corners uncertain by {1.1%}; defocus, come closer, or use a diffuser"},
    {LENSPROF_REASON_FLAT_TEXTURE, Wording::weak,
     "the card has texture of {0.1%} above the noise, all over it, which leaves the falloff in the corners uncertain by {1.2%}; defocus or use a diffuser"},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER, Wording::odd,
     "the shots differ by {0.1%} ({0.3e}), {item} most, in ways that one lens and one light do not explain: it shows another lens or scene, the light changed, a shadow fell on the card, or the angles of the rotated shots are wrong"},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER, Wording::usual,
     "the shots differ by {0.1%} ({0.3e}) in ways that one lens and one light do not explain: one shows another lens or scene, the light changed, a shadow fell on the card, or the angles of the rotated shots are wrong"},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER, Wording::less,
     "the shots differ by {0.1%} ({0.3e}), {item} most, in ways that one lens and one light do not explain"},
    {LENSPROF_REASON_FLAT_SHOTS_DIFFER, Wording::weak,
     "the shots differ by {0.1%} ({0.3e}) in ways that one lens and one light do not explain"},
    {LENSPROF_REASON_FLAT_STEEP, Wording::usual,
     "the light of {item} varies by {0%} ({0.2e}) per half diagonal, which a plane does not describe; even it out"},
    {LENSPROF_REASON_FLAT_STEEP, Wording::alone,
     "the light of {item} varies by {0%} ({0.2e}) per half diagonal; without a rotated shot it cannot be separated from the lens; even it out, or add a shot with the camera rotated by 90 or 180 degrees"},
    {LENSPROF_REASON_FLAT_STEEP, Wording::weak,
     "the light varies by {0%} ({0.2e}) per half diagonal, or the lens is off centre; without a rotated shot, only the prior on the centre separates them; add a shot with the camera rotated by 90 or 180 degrees"},
    {LENSPROF_REASON_FLAT_NOT_RADIAL, Wording::alone,
     "{0.1%} of the light is not radial: a shadow, a second lamp, wrong angles, or the lens; show the card at three different angles of the camera, which separates lens and light"},
    {LENSPROF_REASON_FLAT_NOT_RADIAL, Wording::alone_grid,
     "{0.1%} of the light is not radial, and is in the gain grid: a shadow, a second lamp, wrong angles, or the lens; show the card at three different angles of the camera, which separates lens and light"},
    {LENSPROF_REASON_FLAT_NOT_RADIAL, Wording::grid,
     "{0.1%} of the light is not radial: the gain grid describes it, except for {1.1%}"},
    {LENSPROF_REASON_FLAT_NOT_RADIAL, Wording::usual,
     "{0.1%} of the light is not radial; request a gain grid"},
    {LENSPROF_REASON_FLAT_DUST, Wording::usual,
     "{0} spots of dust were left out ({2.1%} of the frame), the largest at {3},{4} px; the falloff in the corners is then known to +- {1.2%}"},
    {LENSPROF_REASON_FLAT_EDGE, Wording::usual,
     "the image circle has a radius of {0.2} half diagonals: {1.1%} of the frame lies outside, was left out, and is left as it is by corrections"},
    {LENSPROF_REASON_FLAT_EDGE, Wording::weak,
     "something covers the picture from {0.2} half diagonals from the middle of the frame on, and is not the image circle: {1.1%} of the frame was left out, where the falloff is continued; take it off and shoot again if it is not part of the lens"},
    {LENSPROF_REASON_FLAT_ONE_LIGHT, Wording::usual,
     "a light that is brighter in the middle looks like falloff, and no rotation of the camera shows it: check the profile against ordinary overlapping pictures, or with a second light"},
    {LENSPROF_REASON_FLAT_BLACK_LEVEL, Wording::usual,
     "the black level is known to +- {0.2%} of full scale only, which leaves the falloff in the corners uncertain by {1.2} EV: state the level, or give dark frames, or the same card at two exposures"},
    {LENSPROF_REASON_FLAT_BLACK_LEVEL, Wording::weak,
     "the pictures show an offset of {0.3%} +- {1.3%} of full scale from the black level, which was subtracted"},
    {LENSPROF_REASON_FLAT_NEEDS_GRID, Wording::usual,
     "k1..k3 alone are off by up to {0%} of the light: the falloff is not such a polynomial, and the gain grid holds the rest; a program without the grid corrects wrongly"},
    {LENSPROF_REASON_FLAT_NEEDS_GRID, Wording::alone,
     "k1..k3 alone are off by up to {0%} of the light: the falloff is not such a polynomial; request a gain grid"},
    {LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, Wording::usual,
     "no rotated shot separates the gradient of the light from the centre, which depends on its prior; stating an even light would change the falloff in a corner by {0.2} EV"},
    {LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, Wording::less,
     "no rotated shot separates the gradient of the light from the centre: even light and the prior on the centre describe the pictures; stating a sloping light would change the falloff in a corner by {0.2} EV"},
    {LENSPROF_REASON_FLAT_CENTER_BY_PRIOR, Wording::held,
     "no rotated shot separates the gradient of the light from the centre, which depends on its prior"},
    {LENSPROF_REASON_FIELDS_FEW, Wording::usual,
     "the number of pictures that differ and show light is {0}; at least 3 are needed, and {1} or more of different scenes are better"},
    {LENSPROF_REASON_FIELDS_FEW, Wording::weak,
     "with {0} pictures that differ, the error of the shading is itself uncertain; add pictures of other scenes, {1} in all or more"},
    {LENSPROF_REASON_FIELDS_REPEATED, Wording::usual,
     "pictures that repeat another one were left out: {0}, the first of them {item}"},
    {LENSPROF_REASON_FIELDS_PATTERN, Wording::usual,
     "the pictures show one scene: fine detail of {0%} of the light, {1%} of all that varies, is common to all of them; move the specimen between pictures"},
    {LENSPROF_REASON_FIELDS_PATTERN, Wording::weak,
     "fine detail of {0.1%} of the light is common to all pictures: dust, an edge of the shading, or a part of the scene that all share"},
    {LENSPROF_REASON_FIELDS_UNCERTAIN, Wording::usual,
     "the shading has a standard error of {0.1%}; add pictures of other scenes, best with some empty background"},
    {LENSPROF_REASON_FIELDS_UNCERTAIN, Wording::alone,
     "the shading has a standard error of {0.1%}, as the pictures do not determine the offset (pedestal); give the offset, or add pictures with more and less light"},
    {LENSPROF_REASON_FIELDS_OFFSET, Wording::usual,
     "the pictures do not determine the offset (pedestal), which was taken as 0; give it, or add pictures with more and less light"},
    {LENSPROF_REASON_FIELDS_WHITE, Wording::usual,
     "{0%} of the picture cells are saturated and were left out; expose less"},
    {LENSPROF_REASON_FIELDS_WHITE, Wording::weak, "{0.1%} of the picture cells are saturated and were left out"},
    {LENSPROF_REASON_FIELDS_WHITE, Wording::alone,
     "pictures that are saturated or excluded in more than half of the frame were left out: {0}"},
    {LENSPROF_REASON_FIELDS_BLACK, Wording::usual, "pictures without light, or with one value only, were left out: {0}"},
    {LENSPROF_REASON_FIELDS_UNSEEN, Wording::usual,
     "{0%} of the frame is usable in no picture; expose less, or exclude less"},
    {LENSPROF_REASON_FIELDS_UNSEEN, Wording::weak,
     "{0.1%} of the frame is usable in no picture; the shading is continued there"},
    {LENSPROF_REASON_FIELDS_GAIN, Wording::usual,
     "an even frame predicts held-out pictures as well as the shading: it may be even, or the pictures are too few"},
    {LENSPROF_REASON_PRIOR_OVERRULED, Wording::usual,
     "the profile given as the prior contradicts the pictures (it is off by {0.1}, held-out pairs by {1.1} standard errors) and was rejected; check that it is for this lens and setting"},
    {LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED, Wording::usual,
     "the response of the profile given as the prior contradicts the pictures (its shape is off by {0.1}, held-out pairs by {1.1} standard errors) and was rejected; its falloff was used"},
    {LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED, Wording::usual,
     "the falloff of the profile given as the prior contradicts the pictures (it is off by {0.1}, held-out pairs by {1.1} standard errors) and was rejected; its response was used"},
    {LENSPROF_REASON_UNDETERMINED, Wording::usual,
     "the pairs do not determine all parameters; fix some, or vary the exposure more"},
    {LENSPROF_REASON_FEW_GREYS, Wording::rendering,
     "only {0} of ten parts of the grey value range are covered; take a picture with smooth areas of all brightnesses"},
    {LENSPROF_REASON_SCATTER, Wording::rendering,
     "the rendered picture deviates by {0.1} levels from any curve of the raw values; it may be another shot, or developed differently"},
    {LENSPROF_REASON_PATTERNS, Wording::rendering,
     "tones of {item} were mapped locally (a map of {1.1} levels over the frame remains); switch off D-Lighting, Auto Lighting Optimizer, DRO, HDR and similar functions"},
    {LENSPROF_REASON_PATTERNS, Wording::map,
     "a map of {1.1} levels over the frame of {item} remains; the camera may have mapped tones locally"},
    {LENSPROF_REASON_UNDETERMINED, Wording::rendering,
     "the exponent is known only to {0%}; take a picture with all brightnesses"},
    {LENSPROF_REASON_MISSING_GREYS, Wording::rendering,
     "only grey values from {0.2} to {1.2} (of 1) are measured; beyond them the response is that of a typical camera, continued"},
    {LENSPROF_REASON_UNDETERMINED, Wording::card,
     "the pictures do not determine all parameters: fix the centre, assume even light, or add a shot with the camera rotated"},
};
// clang-format on

std::string sentence_of(lensprof_reason code, Wording wording) {
    for (const Wording wanted : {wording, Wording::usual})
        for (const Sentence &sentence : kSentences)
            if (sentence.code == code && sentence.wording == wanted) return sentence.text;
    return lensprof_reason_text(code);
}

// The value for a placeholder such as "0.1%" or "|0.2".
std::string spell_value(std::string place, const std::array<double, kTextValues> &values) {
    const bool is_size = place[0] == '|';
    if (is_size) place.erase(0, 1);
    const double given = values[static_cast<size_t>(place[0] - '0')], value = is_size ? std::abs(given) : given;
    const size_t point = place.find('.');
    const int decimals = point == std::string::npos ? 0 : place[point + 1] - '0';
    const bool is_share = place.back() == '%', is_ratio = place.back() == 'e';
    const double number = is_share ? 100.0 * value : is_ratio ? std::log2(1.0 + value) : value;
    char text[64];
    std::snprintf(text, sizeof text, is_share ? "%.*f %%" : is_ratio ? "%.*f EV" : "%.*f", decimals, number);
    return text;
}

// Writes the sentence into the finding, and notes where it names the item.
void write_text(const std::string &wording, const std::array<double, kTextValues> &values, lensprof_finding &finding) {
    std::string text;
    for (size_t position = 0; position < wording.size();) {
        if (wording[position] != '{') {
            text += wording[position++];
            continue;
        }
        const size_t end = wording.find('}', position);
        const std::string place = wording.substr(position + 1, end - position - 1);
        const size_t begin = text.size();
        if (place == "item") {
            text += item_word(finding.item.kind) + (" " + std::to_string(finding.item.index));
            finding.item.text_begin = static_cast<uint32_t>(begin);
            finding.item.text_bytes = static_cast<uint32_t>(text.size() - begin);
        } else {
            text += spell_value(place, values);
        }
        position = end + 1;
    }
    std::snprintf(finding.text, sizeof finding.text, "%s", text.c_str());
}

bool is_more_severe(const lensprof_finding &a, const lensprof_finding &b) { return a.severity > b.severity; }

}  // namespace

lensprof_finding passed_of(lensprof_reason code, lensprof_severity severity, double measured, double limit) {
    lensprof_finding finding;
    lensprof_finding_init(&finding);
    finding.code = code, finding.severity = LENSPROF_SEVERITY_PASSED, finding.rule_severity = severity;
    finding.measured = measured, finding.limit = limit;
    return finding;
}

lensprof_finding finding_of(lensprof_reason code, lensprof_severity severity, const Measured &measured, double limit,
                            Wording wording) {
    lensprof_finding finding = passed_of(code, severity, measured.value, limit);
    finding.severity = severity;
    finding.value_count = static_cast<uint32_t>(measured.count);
    std::copy_n(measured.values.begin(), measured.count, finding.value);
    finding.item.kind = measured.kind, finding.item.index = measured.index;
    write_text(sentence_of(code, wording), measured.values, finding);
    return finding;
}

void add_first(Findings &findings, const lensprof_finding &finding) {
    findings.insert(std::lower_bound(findings.begin(), findings.end(), finding, is_more_severe), finding);
}

void add_last(Findings &findings, const lensprof_finding &finding) {
    findings.insert(std::upper_bound(findings.begin(), findings.end(), finding, is_more_severe), finding);
}

void rename_item(uint32_t index, lensprof_finding &finding) {
    lensprof_item &item = finding.item;
    const std::string name = item_word(item.kind) + (" " + std::to_string(index)), old = finding.text;
    item.index = index;
    if (!item.text_bytes) return;
    const std::string text = std::string(old).replace(item.text_begin, item.text_bytes, name);
    item.text_bytes = static_cast<uint32_t>(name.size());
    std::snprintf(finding.text, sizeof finding.text, "%s", text.c_str());
}

lensprof_reason first_code(const Findings &findings) {
    return count_findings(findings) ? static_cast<lensprof_reason>(findings[0].code) : LENSPROF_REASON_NONE;
}

uint32_t count_findings(const Findings &findings) {
    return static_cast<uint32_t>(findings.size()) - count_passed(findings);
}

uint32_t count_passed(const Findings &findings) {
    return static_cast<uint32_t>(std::count_if(findings.begin(), findings.end(), [](const lensprof_finding &finding) {
        return finding.severity == LENSPROF_SEVERITY_PASSED;
    }));
}

bool is_usable(const Findings &findings) {
    return findings.empty() || findings[0].severity != LENSPROF_SEVERITY_REFUSAL;
}

bool has_code(const Findings &findings, lensprof_reason code) {
    return std::any_of(findings.begin(), findings.end(), [=](const lensprof_finding &finding) {
        return finding.code == static_cast<uint32_t>(code) && finding.severity != LENSPROF_SEVERITY_PASSED;
    });
}

}  // namespace lensprof
