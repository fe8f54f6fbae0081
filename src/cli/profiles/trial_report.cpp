#include "cli/profiles/trial_report.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// "2", "1 and 2", "1, 2 and 3".
std::string listed(const std::vector<int64_t> &ids) {
    std::string text;
    for (size_t i = 0; i < ids.size(); i++)
        text += (i == 0 ? "" : i + 1 == ids.size() ? " and " : ", ") + std::to_string(ids[i]);
    return text;
}

// The profiles not clearly worse than the best, including it.
std::vector<int64_t> as_good_as_best(const TrialReport &report) {
    std::vector<int64_t> ids;
    for (size_t i = 0; i < report.ids.size(); i++)
        if (report.candidates[i].as_good_as_best) ids.push_back(report.ids[i]);
    return ids;
}

std::string describe_response(const TrialReport &report, const lensprof_trial_candidate &candidate) {
    switch (candidate.response_from) {
    case LENSPROF_TRIAL_RESPONSE_LINEAR: return "linear response";
    case LENSPROF_TRIAL_RESPONSE_KIND: return "typical response of this kind of camera";
    case LENSPROF_TRIAL_RESPONSE_OTHER:
        return "response of profile " + std::to_string(report.ids[candidate.response_profile]);
    default: return "its own response";
    }
}

void add_response(const TrialReport &report, const lensprof_trial_candidate &candidate, Json &json) {
    static const char *const names[] = {"own", "other", "kind", "linear"};
    json["response"] = names[candidate.response_from];
    json["response_profile"] = candidate.response_from == LENSPROF_TRIAL_RESPONSE_OTHER
                                   ? Json(report.ids[candidate.response_profile])
                                   : Json();
}

Json rings_json(const lensprof_trial_candidate &candidate) {
    static const char *const corners[] = {"not-shown", "agree", "too-dark", "too-bright"};
    Json ev = Json::array(), sigma = Json::array();
    for (uint32_t k = 0; k < candidate.rings; k++)
        ev.push_back(candidate.ring_ev[k]), sigma.push_back(candidate.ring_sigma_ev[k]);
    return {{"corners", corners[candidate.corners]}, {"ring_ev", ev}, {"ring_sigma_ev", sigma}};
}

Json figures_json(const lensprof_trial_candidate &candidate) {
    return {{"rms", candidate.heldout_rms}, {"median", candidate.heldout_median}};
}

std::string label_of(const TrialReport &report, size_t i) {
    return i < report.ids.size() ? "profile " + std::to_string(report.ids[i]) : "no falloff";
}

// "overcorrects the corners by +0.21 +- 0.04 EV".
std::string describe_corners(const lensprof_trial_candidate &candidate, const double *ends, bool is_profile) {
    if (candidate.rings < 2) return "these pictures do not show the corners";
    const uint32_t last = candidate.rings - 1;
    const std::string place = candidate.rings == LENSPROF_TRIAL_RINGS
                                  ? "the corners"
                                  : format("the parts up to r = %.2f, where pairs end,", ends[last]);
    const std::string amount = format("%+.2f +- %.2f EV", candidate.ring_ev[last], candidate.ring_sigma_ev[last]);
    const bool is_bright = candidate.corners == LENSPROF_TRIAL_CORNERS_TOO_BRIGHT;
    switch (candidate.corners) {
    case LENSPROF_TRIAL_CORNERS_AGREE: return place + " agree within the error: " + amount;
    case LENSPROF_TRIAL_CORNERS_NOT_SHOWN: return "these pictures do not show whether it is right: " + amount;
    default:
        if (is_profile) return (is_bright ? "overcorrects " : "undercorrects ") + place + " by " + amount;
        return place + (is_bright ? " are too bright by " : " are too dark by ") + amount;
    }
}

bool leaves_corners_wrong(const lensprof_trial_candidate &candidate) {
    return candidate.corners == LENSPROF_TRIAL_CORNERS_TOO_DARK
           || candidate.corners == LENSPROF_TRIAL_CORNERS_TOO_BRIGHT;
}

// The profile with the most even corners, if the best by RMS clearly leaves these too dark or too bright, and that one
// does not; -1 where rings and RMS agree.
int64_t better_by_rings(const TrialReport &report) {
    const lensprof_trial_candidate &best = report.candidates[report.result.best];
    if (!report.result.usable || !leaves_corners_wrong(best)) return -1;
    const auto left = [&](size_t i) { return std::fabs(report.candidates[i].ring_ev[best.rings - 1]); };
    int64_t flattest = -1;
    for (size_t i = 0; i < report.ids.size(); i++)
        if (report.candidates[i].corners == LENSPROF_TRIAL_CORNERS_AGREE && report.candidates[i].rings == best.rings
            && (flattest < 0 || left(i) < left(size_t(flattest))))
            flattest = int64_t(i);
    return flattest;
}

// The residuals of all pairs are of the whole frame, the rings of the falloff alone.
void print_better_by_rings(const TrialReport &report, std::ostream &out) {
    const int64_t even = better_by_rings(report);
    if (even < 0) return;
    const lensprof_trial_result &result = report.result;
    out << "               by RMS, over all pairs, of which few show the corners: it "
        << describe_corners(report.candidates[result.best], result.ring_end, true) << ", and profile "
        << report.ids[size_t(even)] << " leaves them even; use that for its falloff\n";
}

// Per candidate the brightness that it leaves in each ring, relative to the middle, and what follows for the corners.
void print_rings(const TrialReport &report, std::ostream &out) {
    const double *ends = report.result.ring_end;
    out << "brightness left, EV relative to r up to " << format("%.2f", ends[0]) << "; + too bright, - too dark\n";
    out << format("%-14s", "r up to");
    for (size_t k = 1; k < LENSPROF_TRIAL_RINGS; k++) out << format(" %17.2f", ends[k]);
    out << "\n";
    for (size_t i = 0; i < report.candidates.size(); i++) {
        const lensprof_trial_candidate &candidate = report.candidates[i];
        out << format("%-14s", label_of(report, i).c_str());
        for (uint32_t k = 1; k < LENSPROF_TRIAL_RINGS; k++)
            out << format(" %-15s",
                          k < candidate.rings
                              ? format("%+.3f +- %.3f", candidate.ring_ev[k], candidate.ring_sigma_ev[k]).c_str()
                              : "-");
        out << "\n";
    }
    for (size_t i = 0; i < report.candidates.size(); i++)
        out << format("%-14s ", label_of(report, i).c_str())
            << describe_corners(report.candidates[i], ends, i < report.ids.size()) << "\n";
}

}  // namespace

TrialReport::TrialReport(const std::string &database, const std::string &pictures,
                         const std::vector<StoredProfile> &profiles)
    : file(database), path(pictures), candidates(profiles.size() + 1) {
    for (const StoredProfile &stored : profiles)
        ids.push_back(stored.id), labels.push_back(describe_key(stored.profile->key));
    for (lensprof_trial_candidate &candidate : candidates) lensprof_trial_candidate_init(&candidate);
    lensprof_trial_result_init(&result);
}

Json trial_json(const TrialReport &report) {
    Json profiles = Json::array();
    for (size_t i = 0; i < report.ids.size(); i++) {
        const lensprof_trial_candidate &candidate = report.candidates[i];
        Json entry = {{"id", report.ids[i]}};
        entry.update(figures_json(candidate));
        entry["above_best"] = candidate.above_best;
        entry["above_best_sigma"] = candidate.above_best_sigma;
        entry["as_good_as_best"] = candidate.as_good_as_best != 0;
        entry["below_none"] = candidate.below_none;
        entry["below_none_sigma"] = candidate.below_none_sigma;
        entry["better_than_none"] = candidate.better_than_none != 0;
        entry["has_falloff"] = candidate.has_falloff != 0;
        entry.update(rings_json(candidate));
        add_response(report, candidate, entry);
        profiles.push_back(entry);
    }
    Json none = figures_json(report.candidates.back());
    none.update(rings_json(report.candidates.back()));
    add_response(report, report.candidates.back(), none);
    const lensprof_trial_result &result = report.result;
    const int64_t even = better_by_rings(report);
    return {{"schema", json_schema},
            {"file", report.file},
            {"against", report.path},
            {"images", result.images},
            {"fitted", result.fitted},
            {"measured", result.measured},
            {"unexplained", result.unexplained},
            {"before_rms", result.before_rms},
            {"ring_ends", result.ring_end},
            {"none", none},
            {"profiles", profiles},
            {"best", result.usable ? Json(report.ids[result.best]) : Json()},
            {"best_by_rings", even < 0 ? Json() : Json(report.ids[size_t(even)])},
            {"is_decided", result.decided != 0}};
}

void print_trial(const TrialReport &report, std::ostream &out) {
    const lensprof_trial_result &result = report.result;
    const std::string pictures = counted(result.images, "picture");
    out << format("against        %s, exposures fitted to %u pairs and %u others measured",
                  (report.path == pictures ? pictures : report.path + ": " + pictures).c_str(), result.fitted,
                  result.measured);
    if (result.unexplained) out << format(" (%u outliers left out)", result.unexplained);
    out << format("\n%-14s %7s %7s   %-18s levels of 255\n", "", "RMS", "median", "RMS above the best");
    for (size_t i = 0; i < report.candidates.size(); i++) {
        const lensprof_trial_candidate &candidate = report.candidates[i];
        const bool is_profile = i < report.ids.size();
        const std::string above =
            i == result.best ? "" : format("%+.3f +- %.3f", candidate.above_best, candidate.above_best_sigma);
        const std::string response = describe_response(report, candidate);
        const std::string label = !is_profile ? "exposures and white balances alone, " + response
                                              : report.labels[i] + (candidate.has_falloff ? "" : "; has no falloff");
        out << format("%-14s %7.3f %7.3f   %-18s %s\n", label_of(report, i).c_str(), candidate.heldout_rms,
                      candidate.heldout_median, above.c_str(), label.c_str());
        if (is_profile && candidate.response_from != LENSPROF_TRIAL_RESPONSE_OWN)
            out << format("%-51s %s\n", "", response.c_str());
    }
    out << format("%-14s %7.3f\n", "as they are", result.before_rms);
    print_rings(report, out);
    const std::vector<int64_t> best_ids = as_good_as_best(report);
    if (!result.usable)
        out << "best           none\n";
    else if (result.decided)
        out << "best           profile " << report.ids[result.best] << "\n";
    else
        out << "best           profile " << report.ids[result.best]
            << ", but these pictures cannot distinguish profiles " << listed(best_ids)
            << ": they differ by less than "
               "twice the standard error\n";
    print_better_by_rings(report, out);
}

}  // namespace lensprof
