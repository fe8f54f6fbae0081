/* The mean of exposures, which needs exp; what applies profiles does without. */
#include <lensprof/model.h>

#include <math.h>

void lensprof_exposure_mean(const lensprof_exposure *exposures, size_t count, lensprof_exposure *mean) {
    double ev = 0.0, logs[3] = {0.0, 0.0, 0.0}, known = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (isnan(exposures[i].ev)) continue;
        ev += exposures[i].ev, known++;
        for (int c = 0; c < 3; c++) logs[c] += log(exposures[i].white_balance[c]);
    }
    mean->ev = ev / known;
    for (int c = 0; c < 3; c++) mean->white_balance[c] = exp(logs[c] / known);
}
