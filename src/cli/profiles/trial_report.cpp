#include "cli/profiles/trial_report.hpp"

#include <algorithm>
#include <set>

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
    for (const Candidate &candidate : report.profiles)
        if (report.is_as_good(candidate)) ids.push_back(candidate.id);
    return ids;
}

std::string describe_response(const Candidate &candidate) {
    switch (candidate.response_from) {
    case ResponseOf::sensor: return "linear response";
    case ResponseOf::kind: return "typical response of this kind of camera";
    case ResponseOf::other: return "response of profile " + std::to_string(candidate.response_id);
    default: return "its own response";
    }
}

void add_response(const Candidate &candidate, Json &json) {
    static const char *const names[] = {"own", "other", "kind", "linear"};
    json["response"] = names[static_cast<int>(candidate.response_from)];
    json["response_profile"] = candidate.response_id ? Json(candidate.response_id) : Json();
}

Json figures_json(const Candidate &candidate) {
    return {{"rms", candidate.figures.rms}, {"median", candidate.figures.median}};
}

}  // namespace

size_t TrialReport::measured() const {
    return static_cast<size_t>(std::count(is_explained.begin(), is_explained.end(), true));
}

size_t TrialReport::images() const {
    std::set<uint32_t> seen;
    for (const auto *half : {&pairs.train, &pairs.heldout})
        for (const lensprof_pair &pair : *half) seen.insert(pair.image, pair.image + 2);
    return seen.size();
}

bool TrialReport::is_any_better() const {
    return std::any_of(profiles.begin(), profiles.end(),
                       [](const Candidate &candidate) { return candidate.gain_over_none.is_clear(); });
}

bool has_falloff(const lensprof_profile &profile) {
    const auto is_curved = [](const lensprof_vignetting &v) {
        return std::any_of(v.k, v.k + 3, [](double k) { return k != 0.0; });
    };
    return profile.grid.columns || std::any_of(profile.vignetting, profile.vignetting + profile.vignettings, is_curved);
}

void compare(TrialReport &report) {
    std::vector<TrialErrors> errors = {report.none.errors};
    for (const Candidate &candidate : report.profiles) errors.push_back(candidate.errors);
    report.is_explained = explained_pairs(errors);
    report.none.figures = figures_of(report.none.errors, report.is_explained);
    report.before = figures_of(uncorrected_errors(report.pairs), report.is_explained);
    for (size_t i = 0; i < report.profiles.size(); i++) {
        Candidate &candidate = report.profiles[i];
        candidate.figures = figures_of(candidate.errors, report.is_explained);
        candidate.gain_over_none =
            difference_of(report.none.errors, candidate.errors, report.pairs, report.is_explained);
        if (candidate.figures.rms < report.profiles[report.best].figures.rms) report.best = i;
    }
    const TrialErrors &best = report.profiles[report.best].errors;
    for (Candidate &candidate : report.profiles)
        candidate.excess_over_best = difference_of(candidate.errors, best, report.pairs, report.is_explained);
    report.none.excess_over_best = difference_of(report.none.errors, best, report.pairs, report.is_explained);
}

Json trial_json(const TrialReport &report) {
    Json profiles = Json::array();
    for (const Candidate &candidate : report.profiles) {
        Json entry = {{"id", candidate.id}};
        entry.update(figures_json(candidate));
        entry["above_best"] = candidate.excess_over_best.levels;
        entry["above_best_sigma"] = candidate.excess_over_best.sigma;
        entry["as_good_as_best"] = report.is_as_good(candidate);
        entry["below_none"] = candidate.gain_over_none.levels;
        entry["below_none_sigma"] = candidate.gain_over_none.sigma;
        entry["better_than_none"] = candidate.gain_over_none.is_clear();
        entry["has_falloff"] = candidate.has_falloff;
        add_response(candidate, entry);
        profiles.push_back(entry);
    }
    Json none = figures_json(report.none);
    add_response(report.none, none);
    const bool is_any = report.is_any_better();
    return {{"schema", json_schema},
            {"file", report.file},
            {"against", report.path},
            {"images", report.images()},
            {"fitted", report.pairs.train.size()},
            {"measured", report.measured()},
            {"unexplained", report.is_explained.size() - report.measured()},
            {"before_rms", report.before.rms},
            {"none", none},
            {"profiles", profiles},
            {"best", is_any ? Json(report.profiles[report.best].id) : Json()},
            {"is_decided", is_any && as_good_as_best(report).size() == 1}};
}

void print_trial(const TrialReport &report, std::ostream &out) {
    const std::string pictures = counted(report.images(), "picture");
    out << format("against        %s, exposures fitted to %zu pairs and %zu others measured",
                  (report.path == pictures ? pictures : report.path + ": " + pictures).c_str(),
                  report.pairs.train.size(), report.measured());
    if (report.measured() < report.is_explained.size())
        out << format(" (%zu outliers left out)", report.is_explained.size() - report.measured());
    out << format("\n%-14s %7s %7s   %-18s levels of 255\n", "", "RMS", "median", "RMS above the best");
    for (size_t i = 0; i < report.profiles.size(); i++) {
        const Candidate &candidate = report.profiles[i];
        const std::string above = i == report.best ? ""
                                                   : format("%+.3f +- %.3f", candidate.excess_over_best.levels,
                                                            candidate.excess_over_best.sigma);
        const std::string without = candidate.has_falloff ? "" : "; has no falloff";
        out << format("%-14s %7.3f %7.3f   %-18s %s%s\n", ("profile " + std::to_string(candidate.id)).c_str(),
                      candidate.figures.rms, candidate.figures.median, above.c_str(), candidate.label.c_str(),
                      without.c_str());
        if (candidate.response_from != ResponseOf::own)
            out << format("%-51s %s\n", "", describe_response(candidate).c_str());
    }
    out << format(
        "%-14s %7.3f %7.3f   %-18s exposures and white balances alone, %s\n", "no falloff", report.none.figures.rms,
        report.none.figures.median,
        format("%+.3f +- %.3f", report.none.excess_over_best.levels, report.none.excess_over_best.sigma).c_str(),
        describe_response(report.none).c_str());
    out << format("%-14s %7.3f\n", "as they are", report.before.rms);
    const std::vector<int64_t> best_ids = as_good_as_best(report);
    if (!report.is_any_better())
        out << "best           none\n";
    else if (best_ids.size() == 1)
        out << "best           profile " << best_ids[0] << "\n";
    else
        out << "best           profile " << report.profiles[report.best].id
            << ", but these pictures cannot distinguish profiles " << listed(best_ids)
            << ": they differ by less than "
               "twice the standard error\n";
}

}  // namespace lensprof
