/* SPDX-License-Identifier: MIT */
/* Places and states: see critical_state.h. */
#include "critical/critical_state.h"

#include <math.h>

#include "base/vec.h"

/* A facet's answer by doubles: t is surely within its open half-space, surely outside, or neither is sure. */
enum facet_side { SIDE_WITHIN, SIDE_OUTSIDE, SIDE_UNSURE };

/* --- translations --- */

void pir_shift_init(pir_shift *shift, pir_vec3 t) {
    const double c[3] = {t.x, t.y, t.z};
    *shift = (pir_shift){.t = t, .is_small = true, .exponent = INT32_MAX};
    for (int k = 0; k < 3; k++) {
        mpz_init(shift->at[k]);
        const int low = pir_double_low_bit(c[k]);
        shift->exponent = low < shift->exponent ? low : shift->exponent;
        shift->is_small = shift->is_small && fabs(c[k]) <= 0x1p+300;
    }
    if (shift->exponent == INT32_MAX)
        shift->exponent = 0;
    for (int k = 0; k < 3; k++)
        if (c[k] != 0)
            pir_integer_of_double(shift->at[k], c[k], shift->exponent);
}

void pir_shift_clear(pir_shift *shift) {
    mpz_clears(shift->at[0], shift->at[1], shift->at[2], NULL);
}

/* --- slacks --- */

pir_slack_form pir_slack_form_of(const pir_rounded_plane *plane, pir_vec3 t) {
    pir_slack_form form;
    for (int i = 0; i < 3; i++) {
        const double x = plane->a[i][0] * t.x, y = plane->a[i][1] * t.y, z = plane->a[i][2] * t.z;
        form.c[i] = x + y + z + plane->b[i];
        form.bound[i] = (fabs(x) + fabs(y) + fabs(z) + fabs(plane->b[i])) * PIR_SLACK_BOUND + PIR_SLACK_LEAST;
    }
    return form;
}

void pir_slack_exact(const pir_critical_map *map, uint32_t life, const pir_shift *shift, pir_exact_plane *plane,
                     mpz_t dst[3]) {
    pir_turned_plane(&map->turned, &map->life[life].faces, plane);
    const int e = shift->exponent;
    for (int i = 0; i < 3; i++) {
        mpz_mul(dst[i], plane->a[i][0], shift->at[0]);
        mpz_addmul(dst[i], plane->a[i][1], shift->at[1]);
        mpz_addmul(dst[i], plane->a[i][2], shift->at[2]);
        mpz_mul(dst[i], dst[i], map->turned.unit);
        if (e > 0)
            mpz_mul_2exp(dst[i], dst[i], (mp_bitcnt_t)e);
        else
            mpz_mul_2exp(plane->b[i], plane->b[i], (mp_bitcnt_t)-e);
        mpz_add(dst[i], dst[i], plane->b[i]);
    }
}

static int sign_of(const double c[3], const double bound[3], const pir_turn_direction *at) {
    const double m[3] = {at->s * at->s, at->s * at->t, at->t * at->t};
    const double value = c[0] * m[0] + c[1] * m[1] + c[2] * m[2];
    const double error = bound[0] * m[0] + bound[1] * fabs(m[1]) + bound[2] * m[2] + PIR_SLACK_LEAST;
    return (value > error) - (value < -error);
}

static enum facet_side filter(const pir_rounded_plane *plane, const pir_shift *shift, const pir_turn_direction *at) {
    const pir_slack_form form = pir_slack_form_of(plane, shift->t);
    int sign = sign_of(form.c, form.bound, at);
    if (sign != 0 && plane->has_sign) {
        double bound[3];
        for (int i = 0; i < 3; i++)
            bound[i] = fabs(plane->o[i]) * PIR_SLACK_BOUND;
        sign *= sign_of(plane->o, bound, at);
    }
    return sign > 0 ? SIDE_OUTSIDE : sign < 0 ? SIDE_WITHIN : SIDE_UNSURE;
}

/* The sign that makes the plane of two edges point outwards; 0 where their facet has no area. Of others 1. */
static int outwards(const pir_critical_map *map, uint32_t life, const pir_turn_angle *angle, pir_turn_when when) {
    const pir_witness *faces = &map->life[life].faces;
    if (!map->plane[life].has_sign)
        return 1;
    mpz_t side[3];
    mpz_inits(side[0], side[1], side[2], NULL);
    pir_turned_sign(&map->turned, true, map->minus_p->arc_ends[faces->p.index].from, map->q->edge_half[faces->q.index],
                    side);
    const int sign = pir_turn_angle_sign(angle, side, when);
    mpz_clears(side[0], side[1], side[2], NULL);
    return sign;
}

/* The sign of the slack by integers; −1 where the facet has no area. */
static int decide(const pir_critical_map *map, uint32_t life, const pir_turn_angle *angle, const pir_shift *shift,
                  pir_turn_when when) {
    const int side = outwards(map, life, angle, when);
    if (side == 0)
        return -1;
    pir_exact_plane plane;
    mpz_t slack[3];
    pir_exact_plane_init(&plane);
    mpz_inits(slack[0], slack[1], slack[2], NULL);
    pir_slack_exact(map, life, shift, &plane, slack);
    const int sign = side * pir_turn_angle_sign(angle, slack, when);
    mpz_clears(slack[0], slack[1], slack[2], NULL);
    pir_exact_plane_clear(&plane);
    return sign;
}

pir_state pir_critical_state_at(const pir_critical_map *map, const pir_turn_angle *angle, uint32_t interval,
                                const pir_shift *shift, pir_turn_when when) {
    const size_t leaf = (size_t)interval + pir_critical_intervals(map);
    const bool filters = angle->direction.known && shift->is_small;
    bool unsure = !filters;
    for (size_t node = leaf; filters && node > 0; node /= 2)
        for (uint32_t i = map->node_start[node]; i < map->node_start[node + 1]; i++) {
            const enum facet_side side = filter(&map->plane[map->node_life[i]], shift, &angle->direction);
            if (side == SIDE_OUTSIDE)
                return PIR_OUTSIDE;
            unsure = unsure || side == SIDE_UNSURE;
        }
    if (!unsure)
        return PIR_INSIDE;
    bool on_plane = false;
    for (size_t node = leaf; node > 0; node /= 2)
        for (uint32_t i = map->node_start[node]; i < map->node_start[node + 1]; i++) {
            const uint32_t life = map->node_life[i];
            if (filters && filter(&map->plane[life], shift, &angle->direction) == SIDE_WITHIN)
                continue;
            const int sign = decide(map, life, angle, shift, when);
            if (sign > 0)
                return PIR_OUTSIDE;
            on_plane = on_plane || sign == 0;
        }
    return on_plane ? PIR_BOUNDARY : PIR_INSIDE;
}

/* --- places --- */

pir_critical_place pir_critical_place_of(const pir_critical_map *map, const pir_turn_angle *angle) {
    if (angle->first)
        return (pir_critical_place){0, false};
    // events below `low` come before the angle, those from `high` on after it
    uint32_t low = 0, high = map->event_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const double *kappa = map->event[middle].kappa;
        int order = (angle->between[0] > kappa[1]) - (angle->between[1] < kappa[0]);
        if (order == 0) {
            pir_turn_angle event;
            pir_turn_angle_init(&event);
            pir_critical_map_angle(map, middle, &event);
            order = pir_turn_angle_order(angle, &event);
            pir_turn_angle_clear(&event);
        }
        if (order == 0)
            return (pir_critical_place){middle + 1, true};
        if (order > 0)
            high = middle;
        else
            low = middle + 1;
    }
    return (pir_critical_place){low, false};
}

static pir_status check_kappa(const pir_critical_map *map, double kappa, const void *ret) {
    if (!map || !ret)
        return PIR_ERR_ARGUMENT;
    return isnan(kappa) || kappa == -INFINITY ? PIR_ERR_NOT_FINITE : PIR_OK;
}

pir_status pir_critical_map_locate(const pir_critical_map *map, double kappa, pir_critical_place *ret_place) {
    const pir_status status = check_kappa(map, kappa, ret_place);
    if (status != PIR_OK)
        return status;
    pir_turn_angle angle;
    pir_turn_angle_init(&angle);
    pir_turn_angle_at(&angle, &map->turned, kappa);
    *ret_place = pir_critical_place_of(map, &angle);
    pir_turn_angle_clear(&angle);
    return PIR_OK;
}

static pir_status check_rotation(const pir_critical_map *map, pir_quat q, const void *ret, const void *ret_is_turn) {
    if (!map || !ret || !ret_is_turn)
        return PIR_ERR_ARGUMENT;
    if (!isfinite(q.x) || !isfinite(q.y) || !isfinite(q.z) || !isfinite(q.w))
        return PIR_ERR_NOT_FINITE;
    return q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0 ? PIR_ERR_ZERO_QUATERNION : PIR_OK;
}

pir_status pir_critical_map_locate_rotation(const pir_critical_map *map, pir_quat rotation, bool *ret_is_turn,
                                            pir_critical_place *ret_place) {
    const pir_status status = check_rotation(map, rotation, ret_place, ret_is_turn);
    if (status != PIR_OK)
        return status;
    pir_turn_angle angle;
    pir_turn_angle_init(&angle);
    *ret_is_turn = pir_turn_angle_of(&angle, &map->turned, rotation, map->start);
    if (*ret_is_turn)
        *ret_place = pir_critical_place_of(map, &angle);
    pir_turn_angle_clear(&angle);
    return PIR_OK;
}

/* --- states --- */

static pir_state state_at(const pir_critical_map *map, const pir_turn_angle *angle, pir_vec3 t) {
    pir_shift shift;
    pir_shift_init(&shift, t);
    const pir_critical_place place = pir_critical_place_of(map, angle);
    const pir_state state = pir_critical_state_at(map, angle, place.interval, &shift, PIR_TURN_AT);
    pir_shift_clear(&shift);
    return state;
}

pir_status pir_critical_map_state(const pir_critical_map *map, double kappa, pir_vec3 translation,
                                  pir_state *ret_state) {
    const pir_status status = check_kappa(map, kappa, ret_state);
    if (status != PIR_OK || !pir_vec_is_finite(translation))
        return status != PIR_OK ? status : PIR_ERR_NOT_FINITE;
    pir_turn_angle angle;
    pir_turn_angle_init(&angle);
    pir_turn_angle_at(&angle, &map->turned, kappa);
    *ret_state = state_at(map, &angle, translation);
    pir_turn_angle_clear(&angle);
    return PIR_OK;
}

pir_status pir_critical_map_state_of(const pir_critical_map *map, pir_quat rotation, pir_vec3 translation,
                                     bool *ret_is_turn, pir_state *ret_state) {
    const pir_status status = check_rotation(map, rotation, ret_state, ret_is_turn);
    if (status != PIR_OK || !pir_vec_is_finite(translation))
        return status != PIR_OK ? status : PIR_ERR_NOT_FINITE;
    pir_turn_angle angle;
    pir_turn_angle_init(&angle);
    *ret_is_turn = pir_turn_angle_of(&angle, &map->turned, rotation, map->start);
    if (*ret_is_turn)
        *ret_state = state_at(map, &angle, translation);
    pir_turn_angle_clear(&angle);
    return PIR_OK;
}

pir_status pir_critical_map_state_at_event(const pir_critical_map *map, uint32_t event, pir_vec3 translation,
                                           pir_state *ret_state) {
    if (!map || !ret_state || event >= map->event_count)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(translation))
        return PIR_ERR_NOT_FINITE;
    pir_turn_angle angle;
    pir_shift shift;
    pir_turn_angle_init(&angle);
    pir_shift_init(&shift, translation);
    pir_critical_map_angle(map, event, &angle);
    *ret_state = pir_critical_state_at(map, &angle, event + 1, &shift, PIR_TURN_AT);
    pir_shift_clear(&shift);
    pir_turn_angle_clear(&angle);
    return PIR_OK;
}
