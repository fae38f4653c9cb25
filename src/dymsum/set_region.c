/* SPDX-License-Identifier: MIT */
/* The calls about regions. The idea stands in region/region.c. */
#include "dymsum/rotate.h"

/* Changes what is kept to what a cone needs that the cover does not hold. */
static pir_status change_cone(pir_sum *sum, const pir_cone *cone) {
    pir_region *region = &sum->region;
    const pir_cone cone_before = region->cone;
    const pir_cover cover_before = region->cover;
    region->cone = *cone;
    if (cone_before.set && cone->set)
        pir_region_centre(region, &sum->tracked);
    else
        pir_region_centre_afresh(region, &sum->tracked);
    pir_region_choose(region, &sum->tracked);
    if (pir_region_admit(region, &sum->tracked))
        return PIR_OK;
    // back to what there was memory for
    region->cone = cone_before;
    region->cover = cover_before;
    pir_status again = pir_sum_walk(sum);
    PIR_ASSERT(again == PIR_OK);
    (void)again;
    return PIR_ERR_MEMORY;
}

/* Whether what is kept includes all of the region's cone, where the pairing is exact and where it is shown. */
static bool holds(const pir_sum *sum) {
    return pir_region_holds(&sum->region, &sum->tracked.pairing.signs.rotation) &&
           (!sum->lag.lagging || pir_region_holds(&sum->region, &sum->lag.knots->now));
}

pir_status pir_sum_set_region(pir_sum *sum, pir_vec3 axis, double half_angle) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    pir_region *region = &sum->region;
    pir_cone cone, before = region->cone;
    pir_status status = pir_cone_make(axis, half_angle, &cone);
    if (status != PIR_OK || (!cone.set && !before.set))
        return status;
    if (!pir_region_reserve(region, &sum->tracked))
        return PIR_ERR_MEMORY;
    pir_sum_changes(sum);
    if (before.set && cone.set && before.half_angle == cone.half_angle) {
        region->cone = cone;
        if (holds(sum))
            return PIR_OK;
        region->cone = before;
    }
    // a pairing that has stayed behind is settled first
    status = pir_sum_settle(sum);
    return status == PIR_OK ? change_cone(sum, &cone) : status;
}

pir_status pir_sum_clear_region(pir_sum *sum) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    const pir_cone *cone = &sum->region.cone;
    return cone->set ? pir_sum_set_region(sum, cone->axis, PIR_WHOLE_HALF_ANGLE) : PIR_OK;
}

bool pir_sum_region(const pir_sum *sum, pir_vec3 *ret_axis, double *ret_half_angle) {
    if (!sum->region.cone.set)
        return false;
    *ret_axis = sum->region.cone.axis;
    *ret_half_angle = sum->region.cone.half_angle;
    return true;
}
