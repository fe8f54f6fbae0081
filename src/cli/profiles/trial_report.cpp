#include "cli/profiles/trial_report.hpp"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "cli/program/format.hpp"

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
    for (const Candidate &own : report.profiles)
        if (report.is_as_good(own)) ids.push_back(own.id);
    return ids;
}

std::string describe_response(const Candidate &own) {
    switch (own.response_from) {
    case ResponseOf::sensor: return "linear response";
    case ResponseOf::kind: return "typical response of this kind of camera";
    case ResponseOf::other: return "response of profile " + std::to_string(own.response_id);
    default: return "its own response";
    }
}

void add_response(const Candidate &own, Json &json) {
    static const char *const names[] = {"own", "other", "kind", "linear"};
    json["response"] = names[static_cast<int>(own.response_from)];
    json["response_profile"] = own.response_id ? Json(own.response_id) : Json();
}

Json figures_json(const Candidate &own) { return {{"rms", own.figures.rms}, {"median", own.figures.median}}; }

}  // namespace

size_t TrialReport::measured() const { return static_cast<size_t>(std::count(counts.begin(), counts.end(), true)); }

size_t TrialReport::images() const {
    std::set<uint32_t> seen;
    for (const auto *half : {&pairs.train, &pairs.heldout})
        for (const lensprof_pair &pair : *half) seen.insert(pair.image, pair.image + 2);
    return seen.size();
}

bool TrialReport::is_any_better() const {
    return std::any_of(profiles.begin(), profiles.end(),
                       [](const Candidate &own) { return own.below_none.is_clear(); });
}

bool has_falloff(const lensprof_profile &profile) {
    const auto is_curved = [](const lensprof_vignetting &v) {
        return std::any_of(v.k, v.k + 3, [](double k) { return k != 0.0; });
    };
    return profile.grid.columns || std::any_of(profile.vignetting, profile.vignetting + profile.vignettings, is_curved);
}

void compare(TrialReport &report) {
    std::vector<TrialErrors> tried = {report.none.errors};
    for (const Candidate &own : report.profiles) tried.push_back(own.errors);
    report.counts = explained_pairs(tried);
    report.none.figures = figures_of(report.none.errors, report.counts);
    report.before = figures_of(errors_as_they_are(report.pairs), report.counts);
    for (size_t i = 0; i < report.profiles.size(); i++) {
        Candidate &own = report.profiles[i];
        own.figures = figures_of(own.errors, report.counts);
        own.below_none = difference_of(report.none.errors, own.errors, report.pairs, report.counts);
        if (own.figures.rms < report.profiles[report.best].figures.rms) report.best = i;
    }
    const TrialErrors &best = report.profiles[report.best].errors;
    for (Candidate &own : report.profiles)
        own.above_best = difference_of(own.errors, best, report.pairs, report.counts);
    report.none.above_best = difference_of(report.none.errors, best, report.pairs, report.counts);
}

Json trial_json(const TrialReport &report) {
    Json profiles = Json::array();
    for (const Candidate &own : report.profiles) {
        Json one = {{"id", own.id}};
        one.update(figures_json(own));
        one["above_best"] = own.above_best.levels;
        one["above_best_sigma"] = own.above_best.sigma;
        one["as_good_as_best"] = report.is_as_good(own);
        one["below_none"] = own.below_none.levels;
        one["below_none_sigma"] = own.below_none.sigma;
        one["better_than_none"] = own.below_none.is_clear();
        one["has_falloff"] = own.has_falloff;
        add_response(own, one);
        profiles.push_back(one);
    }
    Json none = figures_json(report.none);
    add_response(report.none, none);
    const bool is_any = report.is_any_better();
    return {{"schema", 1},
            {"file", report.file},
            {"against", report.path},
            {"images", report.images()},
            {"fitted", report.pairs.train.size()},
            {"measured", report.measured()},
            {"unexplained", report.counts.size() - report.measured()},
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
    if (report.measured() < report.counts.size())
        out << format(" (%zu outliers left out)", report.counts.size() - report.measured());
    out << format("\n%-14s %7s %7s   %-18s levels of 255\n", "", "RMS", "median", "RMS above the best");
    for (size_t i = 0; i < report.profiles.size(); i++) {
        const Candidate &own = report.profiles[i];
        const std::string above =
            i == report.best ? "" : format("%+.3f +- %.3f", own.above_best.levels, own.above_best.sigma);
        const std::string without = own.has_falloff ? "" : "; has no falloff";
        out << format("%-14s %7.3f %7.3f   %-18s %s%s\n", ("profile " + std::to_string(own.id)).c_str(),
                      own.figures.rms, own.figures.median, above.c_str(), own.label.c_str(), without.c_str());
        if (own.response_from != ResponseOf::own) out << format("%-51s %s\n", "", describe_response(own).c_str());
    }
    out << format("%-14s %7.3f %7.3f   %-18s exposures and white balances alone, %s\n", "no falloff",
                  report.none.figures.rms, report.none.figures.median,
                  format("%+.3f +- %.3f", report.none.above_best.levels, report.none.above_best.sigma).c_str(),
                  describe_response(report.none).c_str());
    out << format("%-14s %7.3f\n", "as they are", report.before.rms);
    const std::vector<int64_t> good = as_good_as_best(report);
    if (!report.is_any_better())
        out << "best           none\n";
    else if (good.size() == 1)
        out << "best           profile " << good[0] << "\n";
    else
        out << "best           profile " << report.profiles[report.best].id
            << ", but these pictures cannot distinguish profiles " << listed(good)
            << ": they differ by less than "
               "twice the standard error\n";
}

}  // namespace lensprof
