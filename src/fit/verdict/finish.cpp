#include "fit/verdict/finish.hpp"

#include <algorithm>
#include <vector>

#include "fit/verdict/judge.hpp"
#include "fit/verdict/output.hpp"
#include "fit/verdict/quality.hpp"

namespace lensprof {

namespace {

bool has_pairs(const Problem &problem, int setting) {
    return std::any_of(problem.edges.begin(), problem.edges.end(), [&](const Edge &edge) {
        return problem.setting_of[edge.image[0]] == setting || problem.setting_of[edge.image[1]] == setting;
    });
}

// Copies a result's values for one setting into the caller's array.
void give_setting(const Problem &problem, int number, const FitResult &r) {
    SettingResult &setting = r.settings[problem.setting_number[static_cast<size_t>(number)]];
    setting.images = setting.pairs = 0;
    std::vector<bool> has_pairs(problem.image_count);
    for (const Edge &edge : problem.edges) {
        has_pairs[edge.image[0]] = has_pairs[edge.image[1]] = true;
        if (problem.setting_of[edge.image[0]] == number || problem.setting_of[edge.image[1]] == number)
            setting.pairs += static_cast<uint32_t>(edge.last - edge.first);
    }
    for (uint32_t i = 0; i < problem.image_count; i++)
        setting.images += has_pairs[i] && problem.setting_of[i] == number;
    copy_setting(r, setting);
}

}  // namespace

void finish(const Found &found, const std::function<void(FitResult &)> &judge_result, lensprof_exposure *exposures,
            FitResult &result) {
    FitResult r = result;
    r.iterations = found.iterations;
    r.converged = found.converged;
    std::vector<lensprof_fit_image_quality> image_quality(found.problem.image_count);  // the verdict always needs it
    if (!r.image_quality) r.image_quality = image_quality.data();
    describe_model(found.problem, found.estimate, r);
    describe_heldout(found.tested, found.train, found.has_heldout, r);
    describe_quality(found.problem, found.gauge, found.noise, found.covariance, found.estimate, r);
    uint32_t equalizes = 1;                                  // 1 if all settings with pictures are even
    for (int s = found.problem.settings - 1; s >= 0; s--) {  // the first one last, because it stays in the result
        describe_setting(found.problem, found.gauge, found.covariance, found.estimate, s, r);
        judge(found, judge_result, r);
        if (has_pairs(found.problem, s)) equalizes = std::min(equalizes, r.equalizes);
        if (r.settings) give_setting(found.problem, s, r);
    }
    r.equalizes = equalizes;
    r.image_quality = result.image_quality;
    write_exposures(found.problem, found.estimate, exposures);
    result = r;
}

}  // namespace lensprof
