// The result of `build` next to the true values of a simulated sequence.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"

namespace lensprof {

TrueValues read_truth(const std::string &path, size_t images) {
    TrueValues truth;
    try {
        Json json = Json::parse(read_text(path, max_text_bytes));
        for (const Json &image : json.at("images")) truth.ev.push_back(image.at("ev").get<double>());
        const Json &curves = json.at("vignetting").at("k"), &center = json.at("vignetting").at("center");
        for (size_t n = 0; n < 3; n++) truth.vignetting.k[n] = curves.at(curves.size() / 2).at(n).get<double>();
        for (size_t d = 0; d < 2; d++) truth.vignetting.center[d] = center.at(d).get<double>();
    } catch (const Json::exception &) {
        throw Failure(LENSPROF_ERROR_READ, path + ": is not the truth.json of `lensprof simulate`");
    }
    if (truth.ev.size() != images)
        throw Failure(LENSPROF_ERROR_READ,
                      path
                          + format(": is for %zu images, not for %zu; give the truth.json of this project",
                                   truth.ev.size(), images));
    return truth;
}

void print_comparison(const BuildReport &report, const TrueValues &truth, std::ostream &out) {
    std::vector<double> true_ev, ev;
    std::vector<size_t> images;  // with an exposure
    for (size_t i = 0; i < report.exposures.size(); i++) {
        if (std::isnan(report.exposures[i].ev)) continue;
        images.push_back(i);
        true_ev.push_back(truth.ev[i] - truth.ev[report.reference]);
        ev.push_back(report.exposures[i].ev);
    }
    const size_t n = images.size();
    double mean = 0, true_mean = 0, cross = 0, square = 0;
    for (size_t i = 0; i < n; i++)
        mean += ev[i] / static_cast<double>(n), true_mean += true_ev[i] / static_cast<double>(n);
    for (size_t i = 0; i < n; i++) {
        cross += (ev[i] - mean) * (true_ev[i] - true_mean);
        square += (true_ev[i] - true_mean) * (true_ev[i] - true_mean);
    }
    double gamma = square > 1e-6 && cross > 0 ? cross / square : 1.0;
    double ev_error = 0, ev_aligned = 0, m_error = 0, m_aligned = 0;
    out << "\n"
           "recovered next to true (aligned: without the exponent "
        << format("%.3f", gamma)
        << ", which pictures "
           "alone do not "
           "determine)\n";
    out << "image      EV  recovered     true  aligned\n";
    for (size_t i = 0; i < n; i++) {
        ev_error = std::max(ev_error, std::abs(ev[i] - true_ev[i]));
        ev_aligned = std::max(ev_aligned, std::abs((ev[i] - mean) / gamma - (true_ev[i] - true_mean)));
        out << format("%5zu          %+8.3f %+8.3f %+8.3f\n", images[i], ev[i], true_ev[i], ev[i] / gamma);
    }
    out << "radius falloff  recovered     true  aligned\n";
    for (int k = 0; k <= 4; k++) {
        double r2 = k * k / 16.0, m = lensprof_vignetting_eval(&green_falloff(report.fit), r2, nullptr);
        double t = lensprof_vignetting_eval(&truth.vignetting, r2, nullptr), a = std::pow(m, 1.0 / gamma);
        m_error = std::max(m_error, std::abs(m - t));
        m_aligned = std::max(m_aligned, std::abs(a - t));
        out << format("%6.2f         %8.4f %8.4f %8.4f\n", k / 4.0, m, t, a);
    }
    out << format("centre         %+.4f %+.4f, true %+.4f %+.4f half diagonals\n", report.fit.vignetting[0].center[0],
                  report.fit.vignetting[0].center[1], truth.vignetting.center[0], truth.vignetting.center[1]);
    out << format("largest error  exposure %.4f EV (aligned %.4f), falloff %.4f (aligned %.4f)\n", ev_error, ev_aligned,
                  m_error, m_aligned);
}

}  // namespace lensprof
