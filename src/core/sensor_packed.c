/* Sensor plans on packed rows. */
#include "core/packed.h"
#include "core/sensor.h"

static lensprof_status apply_in_place(const void *plan, const lensprof_target *samples, uint32_t x0, uint32_t y0) {
    return lensprof_sensor_apply(plan, NULL, samples, x0, y0);
}

lensprof_status lensprof_sensor_apply_packed(const lensprof_sensor_plan *plan, uint32_t packing,
                                             const lensprof_packed_image *source, const lensprof_packed_target *target,
                                             uint32_t x0, uint32_t y0) {
    if (!plan) return LENSPROF_ERROR_ARGUMENT;
    const lp_packed_plan packed = {plan, LENSPROF_LAYOUT_GREY, plan->grid.width, plan->grid.height, apply_in_place};
    return lp_apply_packed(&packed, packing, source, target, x0, y0);
}
