/* SPDX-License-Identifier: MIT */
/*
 * Bringing a sum to a rotation: the epoch and the region note the step, and one of the methods finds the pairing. This
 * is the only place where rebuilds and updates meet the region.
 *
 * A call that fails walks back to the rotation before, in the memory that is there.
 */
#include "dymsum/rotate.h"

#include <pirouette/baseline.h>

#include "dymsum/pairing/crossings.h"
#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/brute.h"
#include "dymsum/rebuild/cgm_rebuild.h"
#include "dymsum/rebuild/walk.h"
#include "dymsum/update/update.h"

pir_status pir_sum_walk(pir_sum *sum) {
    pir_tracked *tracked = &sum->tracked;
    pir_region *region = &sum->region;
    const pir_signs *signs = &tracked->pairing.signs;
    uint64_t asked = pir_signs_asked(signs);
    pir_status status;
    bool in_region = region->cone.set && !region->cover.whole;
    if (in_region) {
        status = pir_region_walk(region, tracked) ? PIR_OK : PIR_ERR_MEMORY;
    } else {
        pir_crossings_forget(tracked);
        pir_region_open(region, tracked);
        status = pir_walk_rebuild(tracked);
    }
    if (status == PIR_OK)
        pir_learn_walk_work(&sum->cost, pir_signs_asked(signs) - asked, in_region, pir_region_share(region, tracked));
    return status;
}

/* A rebuild that pairs all features: by the overlay of two CGMs, or by checking all pairs. */
static pir_status rebuild_all(pir_sum *sum, bool by_cgm) {
    pir_tracked *tracked = &sum->tracked;
    pir_crossings_clear(tracked);
    pir_region_open(&sum->region, tracked);
    pir_status status = by_cgm ? pir_cgm_rebuild(tracked, &sum->cgm_q) : pir_brute_rebuild(tracked);
    if (status == PIR_OK)
        pir_region_close(&sum->region, tracked);
    return status;
}

static pir_status update(pir_sum *sum) {
    pir_tracked *tracked = &sum->tracked;
    pir_region *region = &sum->region;
    double angle = fabs(tracked->epoch.stride);
    uint64_t asked = pir_signs_asked(&tracked->pairing.signs);
    pir_region_follow(region, tracked);
    pir_status status = pir_update_repair(tracked, region->jumped);
    if (status == PIR_OK && !pir_region_admit(region, tracked))
        status = PIR_ERR_MEMORY;
    uint64_t signs = pir_signs_asked(&tracked->pairing.signs) - asked;
    pir_learn_update(&sum->cost, angle, signs, pir_region_share(region, tracked));
    return status;
}

/* Advances the epoch to the rotation, and the keys of the certificates with it. */
static void advance_epoch(pir_tracked *tracked, pir_quat before) {
    double shift = 0;
    uint32_t used = pir_certificate_count(tracked);
    pir_quat now = tracked->pairing.signs.rotation.unit;
    bool many_expired = tracked->expired_in_epoch > used;
    switch (pir_epoch_take_step(&tracked->epoch, before, now, many_expired, &shift)) {
    case PIR_EPOCH_CONTINUES:
        break;
    case PIR_EPOCH_REBASED:
        pir_certificates_shift(&tracked->certificates, used, shift);
        break;
    case PIR_EPOCH_BEGINS:
        pir_certificates_set_now(&tracked->certificates, now);
        pir_certificates_new_epoch(&tracked->certificates, used, tracked->epoch.axial, tracked->epoch.expected);
        tracked->expired_in_epoch = 0;
        break;
    }
}

/*
 * Makes the pairing of rotation `before` again, which fits the memory that is there. The epoch ends with the next step.
 * Returns `status`, the error that led here.
 */
static pir_status roll_back(pir_sum *sum, pir_quat before, const pir_cover *cover, pir_status status) {
    pir_rotation_set(&sum->tracked.pairing.signs.rotation, before);
    sum->region.cover = *cover;
    pir_status again = pir_sum_walk(sum);
    PIR_ASSERT(again == PIR_OK);
    (void)again;
    return status;
}

pir_status pir_sum_stay_behind(pir_sum *sum, pir_quat rotation, bool *ret_done) {
    pir_rotation now;
    pir_status status = pir_rotation_set(&now, rotation);
    if (status != PIR_OK)
        return status;
    double angle = pir_rotation_angle_bound(sum->tracked.pairing.signs.rotation.unit, now.unit);
    // where there is a region, all directions of its cone are kept at both rotations
    *ret_done = pir_lag_allows(&sum->lag, angle) && pir_region_holds(&sum->region, &now);
    if (!*ret_done)
        return PIR_OK;
    pir_sum_changes(sum);
    pir_lag_show(&sum->lag, rotation, angle);
    sum->tracked.statistics.kept++;
    return PIR_OK;
}

/* Finds the pairing at the rotation that the signs are at, by `method`. */
static pir_status bring(pir_sum *sum, pir_method method) {
    pir_tracked *tracked = &sum->tracked;
    if (method == PIR_METHOD_AUTO)
        method = pir_choose_method(&sum->cost, fabs(tracked->epoch.stride));
    if (method == PIR_METHOD_UPDATE) {
        tracked->statistics.updates++;
        return update(sum);
    }
    tracked->statistics.rebuilds++;
    pir_status status;
    if (method == PIR_METHOD_CGM) {
        status = rebuild_all(sum, true);
    } else {
        if (sum->region.cone.set)
            pir_region_centre_walk(&sum->region, tracked);
        status = pir_sum_walk(sum);
    }
    pir_learn_walk(&sum->cost);
    return status;
}

pir_status pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method) {
    if (!sum || method < PIR_METHOD_AUTO || method > PIR_METHOD_CGM)
        return PIR_ERR_ARGUMENT;
    // with a tolerance, an update is deferred while the pairing may stay behind; by AUTO, where that is the cheaper way
    if (sum->lag.tolerance > 0 && method <= PIR_METHOD_UPDATE &&
        (method == PIR_METHOD_UPDATE || pir_pays_to_lag(&sum->cost, pir_lag_reach(&sum->lag)))) {
        bool done;
        pir_status kept = pir_sum_stay_behind(sum, rotation, &done);
        if (kept != PIR_OK || done)
            return kept;
    }
    pir_tracked *tracked = &sum->tracked;
    pir_rotation *now = &tracked->pairing.signs.rotation;
    pir_quat before = now->given, unit_before = now->unit;
    const pir_cover cover = sum->region.cover;
    pir_status status = pir_rotation_set(now, rotation);
    if (status != PIR_OK)
        return status;
    pir_sum_changes(sum);
    pir_region_step(&sum->region, tracked, unit_before);
    advance_epoch(tracked, unit_before);
    status = bring(sum, method);
    if (status != PIR_OK)
        return roll_back(sum, before, &cover, status);
    sum->lag.lagging = false;
    return PIR_OK;
}

pir_status pir_sum_rotate_brute_force(pir_sum *sum, pir_quat rotation) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    pir_rotation *now = &sum->tracked.pairing.signs.rotation;
    pir_quat before = now->given;
    const pir_cover cover = sum->region.cover;
    pir_status status = pir_rotation_set(now, rotation);
    if (status != PIR_OK)
        return status;
    pir_sum_changes(sum);
    status = rebuild_all(sum, false);
    if (status != PIR_OK)
        return roll_back(sum, before, &cover, status);
    sum->lag.lagging = false;
    return PIR_OK;
}
