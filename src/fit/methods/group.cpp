#include "fit/methods/group.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "fit/problem/loss.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/limits.hpp"
#include "fit/verdict/quality.hpp"

namespace lensprof {
namespace {

constexpr int kMaxFits = 6;
constexpr size_t kMinPairs = 10;  // of a link that is able to contradict the others

class GroupFit {
public:
    GroupFit(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
             const PairsWithin &pairs_within)
        : options_(options), images_(images), count_(image_count), pairs_within_(pairs_within) {
        group_.joined.assign(count_, true);
        group_.reference = options.reference;
    }

    void run(const FitGroup &fit, lensprof_exposure *exposures, FitResult &result);

private:
    Problem problem(uint32_t reference) const;
    Problem problem() const { return problem(options_.reference); }
    void join_all();
    bool take_largest(const Problem &all);
    void choose_reference();
    bool leave_out(const lensprof_exposure *exposures, const FitResult &r);
    std::vector<uint32_t> undetermined(const lensprof_exposure *exposures, const FitResult &r) const;
    bool break_links(const lensprof_exposure *exposures, const FitResult &r);
    void note_quality(const FitResult &r);
    void describe(lensprof_exposure *exposures, FitResult &r) const;
    template <class Verdict>
    void report_links(const FitResult &all, Verdict &verdict) const;
    bool disagrees(uint32_t image) const;
    lensprof_finding left_out_finding(uint32_t all) const;
    uint32_t count_unverified(uint32_t &first) const;
    bool is_within(const std::array<uint32_t, 2> &link) const {
        return group_.joined[link[0]] && group_.joined[link[1]];
    }

    const lensprof_fit_options &options_;
    const lensprof_fit_image *images_;
    const uint32_t count_;
    const PairsWithin &pairs_within_;
    Group group_;
    std::vector<bool> had_pairs_ = std::vector<bool>(count_, false);  // images, considering all pairs
    std::vector<bool> was_fitted_ = std::vector<bool>(count_, false);
    std::vector<lensprof_fit_image_quality> quality_;              // of every image, from the last fit that included it
    std::vector<bool> banned_ = std::vector<bool>(count_, false);  // images
    std::vector<uint32_t> component_;                              // of all images, through links that are not broken
};

// Groups of images connected by pairs, shared unknowns or held exposures; each group is identified by its smallest
// index.
std::vector<uint32_t> tied_groups(const Problem &problem) {
    std::vector<uint32_t> group = problem.component;
    std::map<std::array<int, 3>, uint32_t> first;
    for (uint32_t i = 0; i < problem.image_count; i++) {
        const auto &balance = problem.balance_unknown[i];
        const uint32_t tied = first.try_emplace({problem.ev_unknown[i], balance[0], balance[2]}, i).first->second;
        const uint32_t low = std::min(group[i], group[tied]), high = std::max(group[i], group[tied]);
        std::replace(group.begin(), group.end(), high, low);
    }
    return group;
}

// The problem of all images, with the pairs of the group's images along links that are not broken.
Problem GroupFit::problem(uint32_t reference) const {
    const std::vector<lensprof_pair> pairs = pairs_within_(group_);
    std::vector<uint32_t> keep(pairs.size());
    std::iota(keep.begin(), keep.end(), 0u);
    lensprof_fit_options options = options_;
    options.reference = reference;
    return make_problem(options, images_, count_, pairs.data(), keep);
}

void GroupFit::join_all() {
    for (uint32_t i = 0; i < count_; i++) group_.joined[i] = !banned_[i];
}

// Selects the component with the most images among those that are not banned; of several, that of the reference, or the
// one with the most pairs. False if no component has pairs.
bool GroupFit::take_largest(const Problem &all) {
    component_ = tied_groups(all);
    std::vector<uint32_t> members(count_, 0), pairs(count_, 0);
    // An image is left out if all of its pairs belong to broken links, even if held values tie it to the others.
    std::vector<bool> is_out(had_pairs_);
    for (const Edge &edge : all.edges) is_out[edge.image[0]] = is_out[edge.image[1]] = false;
    for (uint32_t i = 0; i < count_; i++) {
        is_out[i] = is_out[i] || banned_[i];
        members[component_[i]] += !is_out[i];
    }
    for (const Edge &edge : all.edges)
        pairs[component_[edge.image[0]]] += static_cast<uint32_t>(edge.last - edge.first);
    const auto size_of = [&](uint32_t c) {
        return std::tuple(members[c], c == component_[options_.reference], pairs[c]);
    };
    uint32_t best = 0;
    for (uint32_t c = 0; c < count_; c++) {
        if (pairs[c] == 0) members[c] = 0;  // tied only by shared or held values, which proves nothing
        if (size_of(c) > size_of(best)) best = c;
    }
    if (members[best] < 2) return false;
    for (uint32_t i = 0; i < count_; i++) group_.joined[i] = component_[i] == best && !is_out[i];
    choose_reference();
    return true;
}

// The reference of the options, else the next image of its setting, else the next image.
void GroupFit::choose_reference() {
    const auto next = [&](const auto &is_good) {
        for (uint32_t n = 0; n < count_; n++)
            if (const uint32_t i = (options_.reference + n) % count_; group_.joined[i] && is_good(i))
                return group_.reference = i, true;
        return false;
    };
    const uint32_t setting = images_[options_.reference].setting;
    if (!next([&](uint32_t i) { return images_[i].setting == setting; })) next([](uint32_t) { return true; });
}

// For each setting of the problem.
std::vector<Falloffs> falloffs_of(const Problem &problem, const FitResult &r) {
    std::vector<Falloffs> falloffs;
    for (uint32_t number : problem.setting_number) {
        const lensprof_vignetting *vignetting = r.settings ? r.settings[number].vignetting : r.vignetting;
        falloffs.push_back({vignetting[0], vignetting[1], vignetting[2]});
    }
    return falloffs;
}

// Breaks the links with almost no pair that agrees with the result. Returns whether there are any.
bool GroupFit::break_links(const lensprof_exposure *exposures, const FitResult &r) {
    Problem judged = problem();
    judged.vignettings = static_cast<int>(r.vignettings);
    const Estimate estimate = estimate_of(r.response, falloffs_of(judged, r), exposures, count_, judged.channels);
    const std::vector<double> chi2 = all_chi2(judged, estimate, std::max(r.noise_levels, 0.5) / 255.0);
    bool any = false;
    for (const Edge &edge : judged.edges) {
        size_t agree = 0;
        for (size_t p = edge.first; p < edge.last; p++) agree += chi2[p] < inlier_limit(judged.channels);
        const size_t pairs = edge.last - edge.first;
        if (pairs < kMinPairs || static_cast<double>(agree) > kSmallestLinkShare * static_cast<double>(pairs)) continue;
        group_.broken.insert({edge.image[0], edge.image[1]});
        any = true;
    }
    return any;
}

// The images that have the fault of the verdict, which is about the exposure of the first or worst of them.
std::vector<uint32_t> GroupFit::undetermined(const lensprof_exposure *exposures, const FitResult &r) const {
    std::vector<uint32_t> images;
    if (first_code(r.verdict) == LENSPROF_REASON_FEW_INLIERS)
        for (const FewInliers &few : images_with_few_inliers(problem(group_.reference), r)) images.push_back(few.image);
    if (first_code(r.verdict) == LENSPROF_REASON_EXPOSURE_UNCERTAIN)
        for (uint32_t i = 0; i < count_; i++)
            if (ev_sigma_of_pairs(r, i, exposures[i].ev - exposures[group_.reference].ev) > kLargestEvSigma)
                images.push_back(i);
    return images;
}

// Breaks links that disagree; otherwise leaves out the image that the verdict is about, and with it all that have the
// same fault, unless most have: then the fault is the reference's. Returns whether the group changed.
bool GroupFit::leave_out(const lensprof_exposure *exposures, const FitResult &r) {
    const bool any = break_links(exposures, r);
    const lensprof_reason code = first_code(r.verdict);
    const bool is_of_image = code == LENSPROF_REASON_FEW_INLIERS || code == LENSPROF_REASON_IMAGE_DISAGREES
                             || code == LENSPROF_REASON_EXPOSURE_UNCERTAIN;
    if (any || r.usable || !is_of_image) return any;
    banned_[r.verdict[0].item.index] = true;
    const auto joined = static_cast<size_t>(std::count(group_.joined.begin(), group_.joined.end(), true));
    const std::vector<uint32_t> images = undetermined(exposures, r);
    for (uint32_t i : images) banned_[i] = banned_[i] || 2 * images.size() < joined;
    return true;
}

// Counts the images of the group that no verified links join to the reference, and finds the first of them.
uint32_t GroupFit::count_unverified(uint32_t &first) const {
    std::vector<uint32_t> root(count_);
    std::iota(root.begin(), root.end(), 0u);
    auto root_of = [&](uint32_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (uint32_t n = 0; n < options_.link_count; n++) {
        const lensprof_link &link = options_.links[n];
        if (link.state == LENSPROF_LINK_VERIFIED && group_.holds(link.image[0], link.image[1]))
            root[root_of(link.image[0])] = root_of(link.image[1]);
    }
    uint32_t count = 0;
    for (uint32_t i = count_; i-- > 0 && options_.link_count;)
        if (group_.joined[i] && root_of(i) != root_of(group_.reference)) first = i, count++;
    return count;
}

// Whether pairs, or the link that sampling looked at, are the cause if the image is left out; else no pairs connect it.
bool GroupFit::disagrees(uint32_t image) const {
    return was_fitted_[image]
           || std::any_of(options_.links, options_.links + options_.link_count, [=](const lensprof_link &link) {
                  return link.state == LENSPROF_LINK_CONTRADICTED && (link.image[0] == image || link.image[1] == image);
              });
}

// That `all` images are left out: about those that disagree, if there are any.
lensprof_finding GroupFit::left_out_finding(uint32_t all) const {
    std::vector<uint32_t> disagree, unconnected;
    for (uint32_t i = 0; i < count_; i++)
        if (!group_.joined[i]) (disagrees(i) ? disagree : unconnected).push_back(i);
    if (disagree.empty())
        return found_by_method(LENSPROF_REASON_IMAGES_UNCONNECTED, of_image(of_value(all), unconnected[0]));
    return found_by_method(LENSPROF_REASON_IMAGES_LEFT_OUT, of_image(of_value(double(disagree.size())), disagree[0]));
}

// Stores the quality that the last fit reports for its images.
void GroupFit::note_quality(const FitResult &r) {
    for (uint32_t i = 0; i < count_; i++) was_fitted_[i] = was_fitted_[i] || group_.joined[i];
    quality_.resize(r.image_quality ? count_ : 0);
    for (uint32_t i = 0; i < quality_.size(); i++)
        if (group_.joined[i]) quality_[i] = r.image_quality[i];
}

void GroupFit::describe(lensprof_exposure *exposures, FitResult &r) const {
    r.reference = group_.reference;
    r.left_out = static_cast<uint32_t>(std::count(group_.joined.begin(), group_.joined.end(), false));
    r.components = 0;
    for (uint32_t i = 0; i < count_; i++) {
        r.components += component_[i] == i;
        if (r.image_quality) {
            r.image_quality[i] = quality_[i];
            r.image_quality[i].component = component_[i], r.image_quality[i].joined = group_.joined[i];
        }
        if (!group_.joined[i]) exposures[i].ev = std::numeric_limits<double>::quiet_NaN();
    }
    const bool has_broken =
        std::any_of(group_.broken.begin(), group_.broken.end(), [&](const auto &link) { return is_within(link); });
    const auto minority = minority_finding(options_, count_, r);
    if (2 * r.left_out >= count_ || minority || has_broken) r.equalizes = 0;
    for_each_verdict(r, [&](auto &verdict) {
        report_links(r, verdict);
        if (minority) report_first(verdict, *minority);
    });
}

// Rejects a group that is too small; otherwise reports data that contradict each other.
template <class Verdict>
void GroupFit::report_links(const FitResult &all, Verdict &verdict) const {
    const auto first = std::find(group_.joined.begin(), group_.joined.end(), false) - group_.joined.begin();
    if (2 * all.left_out >= count_) {
        report_first(verdict,
                     found_by_method(LENSPROF_REASON_IMAGE_GROUPS,
                                     of_image(of_value(std::max(all.components, 2u)), static_cast<uint32_t>(first))));
        return;
    }
    const auto note = [&](lensprof_reason code, uint32_t image, size_t count) {
        report_last(verdict, found_by_method(code, of_image(of_value(double(count)), image)));
    };
    const auto is_in_group = [&](const auto &link) { return is_within(link); };
    const auto broken = std::find_if(group_.broken.begin(), group_.broken.end(), is_in_group);
    // Links that sampling found to show something else have no pairs that could contradict the result.
    const auto is_contradicted = [&](const lensprof_link &link) {
        return link.state == LENSPROF_LINK_CONTRADICTED && group_.joined[link.image[0]] && group_.joined[link.image[1]];
    };
    const auto *links = options_.links, *end = links + options_.link_count;
    const auto *contradicted = std::find_if(links, end, is_contradicted);
    if (all.left_out) report_last(verdict, left_out_finding(all.left_out));
    if (broken != group_.broken.end())
        note(LENSPROF_REASON_LINKS_CONTRADICT, (*broken)[0],
             std::count_if(group_.broken.begin(), group_.broken.end(), is_in_group));
    else if (contradicted != end)
        note(LENSPROF_REASON_LINKS_CONTRADICT, contradicted->image[0], std::count_if(links, end, is_contradicted));
    uint32_t unverified = 0;
    if (const uint32_t count = count_unverified(unverified)) note(LENSPROF_REASON_LINKS_UNVERIFIED, unverified, count);
}

void GroupFit::run(const FitGroup &fit, lensprof_exposure *exposures, FitResult &result) {
    const Problem all = problem();
    component_ = all.component;
    for (const Edge &edge : all.edges) had_pairs_[edge.image[0]] = had_pairs_[edge.image[1]] = true;
    const bool may_leave_out = all.image_unknowns > 0 && !is_static(all);
    if (may_leave_out && !take_largest(all)) component_ = all.component, group_.joined.assign(count_, true);
    lensprof_fit_options group_options = options_;
    for (int n = 1;; n++) {
        group_options.reference = group_.reference;
        const bool is_same_setting = images_[group_options.reference].setting == images_[options_.reference].setting;
        group_options.profile = is_same_setting ? options_.profile : nullptr;  // if it has the falloff of that setting
        fit(group_options, group_, exposures, result);
        note_quality(result);
        const Group before = group_;
        const std::vector<uint32_t> component = component_;
        if (!may_leave_out || n == kMaxFits || !leave_out(exposures, result)) break;
        join_all();
        if (take_largest(problem())) continue;
        group_ = before, component_ = component;
        break;
    }
    describe(exposures, result);
}

}  // namespace

std::optional<lensprof_finding> minority_finding(const lensprof_fit_options &options, uint32_t image_count,
                                                 const FitResult &r) {
    const bool is_verified = std::any_of(options.links, options.links + options.link_count,
                                         [](const auto &link) { return link.state == LENSPROF_LINK_VERIFIED; });
    const double joined = image_count - r.left_out, all = double(image_count) + options.unlinked_images;
    const bool is_found = options.unlinked_images && options.link_count && !is_verified && (r.usable || r.equalizes)
                          && joined / all < kSmallestPart;
    if (!is_found) return std::nullopt;
    return found_by_method(LENSPROF_REASON_IMAGES_MINORITY, of_values(joined / all, joined, all));
}

void fit_largest_group(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                       const PairsWithin &pairs_within, const FitGroup &fit, lensprof_exposure *exposures,
                       FitResult &result) {
    GroupFit(options, images, image_count, pairs_within).run(fit, exposures, result);
}

}  // namespace lensprof
