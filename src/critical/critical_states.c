/* SPDX-License-Identifier: MIT */
/*
 * The states of one translation all around a turn, of one pair of bodies or of several.
 *
 * The greatest slack over all facets of a pair is continuous in κ. So the state changes only where that passes 0,
 * which is at a root of the slack at a facet, where the state is boundary: contacts are among such roots. Between two
 * of them the state is constant, and is that just after the first. Of several pairs the state is that of the pair in
 * which t is deepest: roots at which another pair overlaps are no contacts.
 *
 * In most intervals t is outside throughout, as one facet proves, mostly that of the interval before. Contacts are
 * looked for in the others alone. There most slacks keep their sign for the life of their facet. On a cone of
 * directions spanned by v and w, less than a half turn wide, a quadratic is a combination of its values at v and w and
 * of its polar form there with coefficients that are not negative. Where the three have one sign, surely, there is no
 * root. Otherwise the cone is halved a few times.
 */
#include <math.h>

#include <pirouette/exact.h>

#include "base/memory.h"
#include "base/vec.h"
#include "critical/critical_state.h"

/* Halvings of a run of intervals: what is left is 1/32 of it. */
#define HALVINGS 5

#define NO_LIFE UINT32_MAX

struct pir_critical_states {
    pir_allocator allocator;
    pir_critical_angle *contact;
    mpz_t *polynomial; /* three a contact */
    pir_state *after;  /* contacts + 1 */
    uint32_t count;
    size_t room; /* contacts were found */
    pir_state at_start;
};

/* A root of a slack, and whether the state is boundary there. */
struct boundary_root {
    pir_turn_angle angle;
    bool is_contact;
};

struct root_search {
    const pir_critical_map *const *maps;
    size_t map_count;
    const pir_critical_map *map; /* whose roots are being found; all are of one axis */
    pir_allocator allocator;
    pir_shift shift;
    struct boundary_root **root; /* in order, without repeats */
    size_t count, room;
    uint32_t *next_open; /* per interval: the first one from it on that t may be not outside in; else their count */
};

/* --- roots --- */

static double polar(const double c[3], const pir_turn_direction *v, const pir_turn_direction *w) {
    return c[0] * v->s * w->s + 0.5 * c[1] * (v->s * w->t + v->t * w->s) + c[2] * v->t * w->t;
}

/* The sign of the polar form, 0 where doubles cannot tell. Directions are exact here. */
static int polar_sign(const pir_slack_form *form, const pir_turn_direction *v, const pir_turn_direction *w) {
    const pir_turn_direction x = {fabs(v->s), v->t, true}, y = {fabs(w->s), w->t, true};
    const double value = polar(form->c, v, w), error = 2 * polar(form->bound, &x, &y) + PIR_SLACK_LEAST;
    return (value > error) - (value < -error);
}

/* Whether a form may have a root in the cone from v to w. */
static bool may_have_root(const pir_slack_form *form, const pir_turn_direction *v, const pir_turn_direction *w,
                          int halvings) {
    const bool is_half_turn = v->t == 0 && w->t == 0;
    const int sign = is_half_turn ? 0 : polar_sign(form, v, w);
    if (sign != 0 && polar_sign(form, v, v) == sign && polar_sign(form, w, w) == sign)
        return false;
    if (halvings == 0)
        return true;
    pir_turn_direction middle = {0.5 * v->s + 0.5 * w->s, 0.5 * v->t + 0.5 * w->t, true};
    if (is_half_turn)
        middle = (pir_turn_direction){0, 1, true};
    return may_have_root(form, v, &middle, halvings - 1) || may_have_root(form, &middle, w, halvings - 1);
}

/* The direction of an event's κ, rounded upwards for 1 and downwards for 0, or of a start. */
static pir_turn_direction end_of(const pir_critical_map *map, int64_t event, int upwards) {
    if (event < 0)
        return (pir_turn_direction){1, 0, true};
    if (event >= map->event_count)
        return (pir_turn_direction){-1, 0, true};
    const double kappa = map->event[event].kappa[upwards];
    return kappa == 0 ? (pir_turn_direction){0, 1, true} : pir_turn_direction_of(&map->turned, kappa);
}

/* Whether t may pass the plane of a life's facet in intervals of that. */
static bool may_pass(const struct root_search *search, uint32_t life, uint32_t first, uint32_t last) {
    const pir_critical_map *map = search->map;
    const pir_turn_direction v = end_of(map, (int64_t)first - 1, 1), w = end_of(map, last, 0);
    if (!v.known || !w.known || !search->shift.is_small)
        return true;
    const pir_slack_form form = pir_slack_form_of(&map->plane[life], search->shift.t);
    return may_have_root(&form, &v, &w, HALVINGS);
}

/* --- intervals that t is outside in --- */

/* Whether a life's facet surely has t outside in the cone from v to w. */
static bool parts_throughout(const struct root_search *search, uint32_t life, const pir_turn_direction *v,
                             const pir_turn_direction *w) {
    const pir_rounded_plane *plane = &search->map->plane[life];
    const pir_slack_form form = pir_slack_form_of(plane, search->shift.t);
    const int sign = polar_sign(&form, v, v);
    if (sign == 0 || (!plane->has_sign && sign < 0) || polar_sign(&form, v, w) != sign ||
        polar_sign(&form, w, w) != sign)
        return false;
    if (!plane->has_sign)
        return true;
    pir_slack_form side;
    for (int i = 0; i < 3; i++) {
        side.c[i] = plane->o[i];
        side.bound[i] = fabs(plane->o[i]) * PIR_SLACK_BOUND + PIR_SLACK_LEAST;
    }
    return polar_sign(&side, v, v) == sign && polar_sign(&side, v, w) == sign && polar_sign(&side, w, w) == sign;
}

/* A life of an interval that parts throughout, `hint` where that does; NO_LIFE where none is found. */
static uint32_t parting_life(const struct root_search *search, uint32_t interval, uint32_t hint) {
    const pir_critical_map *map = search->map;
    const pir_turn_direction v = end_of(map, (int64_t)interval - 1, 1), w = end_of(map, interval, 0);
    if (!v.known || !w.known || (v.t == 0 && w.t == 0))
        return NO_LIFE;
    if (hint != NO_LIFE && map->life[hint].last >= interval && parts_throughout(search, hint, &v, &w))
        return hint;
    for (size_t node = (size_t)interval + pir_critical_intervals(map); node > 0; node /= 2)
        for (uint32_t i = map->node_start[node]; i < map->node_start[node + 1]; i++)
            if (parts_throughout(search, map->node_life[i], &v, &w))
                return map->node_life[i];
    return NO_LIFE;
}

/*
 * Finds the intervals that t may be not outside in, all of them. After failures in a row some are taken for such
 * without a look: where t is inside, all facets would be looked at in vain.
 */
static bool find_open(struct root_search *search) {
    const uint32_t count = pir_critical_intervals(search->map);
    search->next_open = PIR_NEW(&search->allocator, uint32_t, (size_t)count + 1);
    if (!search->next_open)
        return false;
    uint32_t hint = NO_LIFE, failures = 0, skip = 0;
    for (uint32_t i = 0; i < count; i++) {
        search->next_open[i] = i;
        if (!search->shift.is_small)
            continue;
        if (skip > 0) {
            skip--;
            continue;
        }
        hint = parting_life(search, i, hint);
        failures = hint == NO_LIFE ? failures + 1 : 0;
        skip = failures;
        if (hint != NO_LIFE)
            search->next_open[i] = count;
    }
    search->next_open[count] = count;
    for (uint32_t i = count; i-- > 0;)
        if (search->next_open[i] != i)
            search->next_open[i] = search->next_open[i + 1];
    return true;
}

/* Whether t may pass the plane of a life's facet in an open interval: false proves that it has no contact. */
static bool may_touch(const struct root_search *search, uint32_t life) {
    const pir_facet_life *at = &search->map->life[life];
    for (uint32_t first = search->next_open[at->first]; first <= at->last;) {
        uint32_t last = first;
        while (last < at->last && search->next_open[last + 1] == last + 1)
            last++;
        if (may_pass(search, life, first, last))
            return true;
        first = search->next_open[last + 1];
    }
    return false;
}

/* --- contacts --- */

/* The state at an angle, or just after it: that of the map in which t is deepest. */
static pir_state state_at(const struct root_search *search, const pir_turn_angle *angle, pir_turn_when when) {
    pir_state most = PIR_OUTSIDE;
    for (size_t k = 0; k < search->map_count && most != PIR_INSIDE; k++) {
        const pir_critical_map *map = search->maps[k];
        const uint32_t interval = pir_critical_place_of(map, angle).interval;
        const pir_state state = pir_critical_state_at(map, angle, interval, &search->shift, when);
        most = state > most ? state : most;
    }
    return most;
}

static void free_root(struct root_search *search, struct boundary_root *root) {
    pir_turn_angle_clear(&root->angle);
    PIR_FREE(&search->allocator, root, 1);
}

/* The place that a root has in the order; true where it is there already. */
static bool find_root(const struct root_search *search, const pir_turn_angle *angle, size_t *ret_place) {
    size_t low = 0, high = search->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const int order = pir_turn_angle_order(angle, &search->root[middle]->angle);
        if (order == 0)
            return true;
        if (order > 0)
            high = middle;
        else
            low = middle + 1;
    }
    *ret_place = low;
    return false;
}

static bool insert_root(struct root_search *search, size_t place, struct boundary_root *root) {
    if (search->count == search->room) {
        const size_t room = 2 * search->room + 16;
        struct boundary_root **grown = PIR_RESIZE(&search->allocator, search->root, search->room, room);
        if (!grown)
            return false;
        search->root = grown;
        search->room = room;
    }
    for (size_t i = search->count; i > place; i--)
        search->root[i] = search->root[i - 1];
    search->root[place] = root;
    search->count++;
    return true;
}

/* Keeps a root of a slack, of its negative for `sign` −1, where there is one, with the state there. */
static bool look_at_root(struct root_search *search, mpz_t slack[3], int sign) {
    struct boundary_root *root = PIR_NEW(&search->allocator, struct boundary_root, 1);
    if (!root)
        return false;
    size_t place = 0;
    pir_turn_angle_init(&root->angle);
    if (!pir_turn_angle_root(&root->angle, &search->map->turned, slack, sign) ||
        find_root(search, &root->angle, &place)) {
        free_root(search, root);
        return true;
    }
    root->is_contact = state_at(search, &root->angle, PIR_TURN_AT) == PIR_BOUNDARY;
    if (insert_root(search, place, root))
        return true;
    free_root(search, root);
    return false;
}

static bool find_roots(struct root_search *search) {
    pir_exact_plane plane;
    mpz_t slack[3];
    pir_exact_plane_init(&plane);
    mpz_inits(slack[0], slack[1], slack[2], NULL);
    bool fits = true;
    for (uint32_t i = 0; i < search->map->life_count && fits; i++) {
        if (!may_touch(search, i))
            continue;
        pir_slack_exact(search->map, i, &search->shift, &plane, slack);
        fits = look_at_root(search, slack, 1) && look_at_root(search, slack, -1);
    }
    mpz_clears(slack[0], slack[1], slack[2], NULL);
    pir_exact_plane_clear(&plane);
    return fits;
}

static bool find_contacts(struct root_search *search) {
    bool fits = true;
    for (size_t k = 0; k < search->map_count && fits; k++) {
        search->map = search->maps[k];
        fits = find_open(search) && find_roots(search);
        PIR_FREE(&search->allocator, search->next_open, (size_t)pir_critical_intervals(search->map) + 1);
        search->next_open = NULL;
    }
    return fits;
}

/* --- answers --- */

static pir_state state_at_start(const struct root_search *search, pir_turn_when when) {
    pir_turn_angle first;
    pir_turn_angle_init(&first);
    pir_turn_angle_at(&first, &search->maps[0]->turned, INFINITY);
    const pir_state state = state_at(search, &first, when);
    pir_turn_angle_clear(&first);
    return state;
}

/* Fills in the answers. Contacts within a stretch of boundary are none. */
static bool tell(struct root_search *search, pir_critical_states *states) {
    const pir_turned *turned = &search->maps[0]->turned;
    states->contact = PIR_NEW(&search->allocator, pir_critical_angle, search->count);
    states->polynomial = PIR_NEW(&search->allocator, mpz_t, 3 * search->count);
    states->after = PIR_NEW(&search->allocator, pir_state, search->count + 1);
    if (!states->contact || !states->polynomial || !states->after) {
        PIR_FREE(&search->allocator, states->contact, search->count);
        PIR_FREE(&search->allocator, states->polynomial, 3 * search->count);
        PIR_FREE(&search->allocator, states->after, search->count + 1);
        return false;
    }
    uint32_t count = 0;
    states->at_start = state_at_start(search, PIR_TURN_AT);
    states->after[0] = state_at_start(search, PIR_TURN_AFTER);
    for (size_t i = 0; i < search->count; i++) {
        pir_turn_angle *angle = &search->root[i]->angle;
        if (!search->root[i]->is_contact)
            continue;
        const pir_state after = state_at(search, angle, PIR_TURN_AFTER);
        if (after == PIR_BOUNDARY && states->after[count] == PIR_BOUNDARY)
            continue;
        pir_turn_angle_tighten(angle, turned);
        mpz_t *polynomial = &states->polynomial[3 * (size_t)count];
        for (int k = 0; k < 3; k++)
            mpz_init(polynomial[k]);
        pir_turn_angle_polynomial(angle, turned, polynomial);
        pir_critical_angle *told = &states->contact[count++];
        *told = (pir_critical_angle){.kappa = {angle->between[0], angle->between[1]}};
        pir_turning_degrees(turned->length, turned->exponent, told->kappa, told->degrees);
        states->after[count] = after;
    }
    states->count = count;
    states->room = search->count;
    return true;
}

/* Whether maps are of turns about one axis from one start, whose κ mean the same. */
static bool are_one_turn(const pir_critical_map *const *maps, size_t count) {
    for (size_t k = 0; k < count; k++) {
        if (!maps[k])
            return false;
        const pir_vec3 a = maps[0]->axis, b = maps[k]->axis;
        const pir_quat p = maps[0]->start, q = maps[k]->start;
        if (a.x != b.x || a.y != b.y || a.z != b.z || p.x != q.x || p.y != q.y || p.z != q.z || p.w != q.w)
            return false;
    }
    return count > 0;
}

pir_status pir_critical_states_create(const pir_critical_map *const *maps, size_t count, pir_vec3 translation,
                                      const pir_allocator *allocator, pir_critical_states **ret_states) {
    if (!maps || !ret_states || !are_one_turn(maps, count))
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(translation))
        return PIR_ERR_NOT_FINITE;
    struct root_search search = {.maps = maps, .map_count = count, .allocator = pir_allocator_or_default(allocator)};
    pir_critical_states *states = PIR_ZEROED(&search.allocator, pir_critical_states, 1);
    if (!states)
        return PIR_ERR_MEMORY;
    pir_shift_init(&search.shift, translation);
    const bool made = find_contacts(&search) && tell(&search, states);
    states->allocator = search.allocator;
    for (size_t i = 0; i < search.count; i++)
        free_root(&search, search.root[i]);
    PIR_FREE(&search.allocator, search.root, search.room);
    pir_shift_clear(&search.shift);
    if (made)
        *ret_states = states;
    else
        PIR_FREE(&search.allocator, states, 1);
    return made ? PIR_OK : PIR_ERR_MEMORY;
}

void pir_critical_states_destroy(pir_critical_states *states) {
    if (!states)
        return;
    const pir_allocator a = states->allocator;
    for (size_t i = 0; i < 3 * (size_t)states->count; i++)
        mpz_clear(states->polynomial[i]);
    PIR_FREE(&a, states->contact, states->room);
    PIR_FREE(&a, states->polynomial, 3 * states->room);
    PIR_FREE(&a, states->after, states->room + 1);
    PIR_FREE(&a, states, 1);
}

uint32_t pir_critical_states_count(const pir_critical_states *states) {
    return states->count;
}

pir_status pir_critical_states_contact(const pir_critical_states *states, uint32_t contact,
                                       pir_critical_angle *ret_angle) {
    if (!states || !ret_angle || contact >= states->count)
        return PIR_ERR_ARGUMENT;
    *ret_angle = states->contact[contact];
    return PIR_OK;
}

pir_status pir_critical_states_after(const pir_critical_states *states, uint32_t contacts, pir_state *ret_state) {
    if (!states || !ret_state || contacts > states->count)
        return PIR_ERR_ARGUMENT;
    *ret_state = states->after[contacts];
    return PIR_OK;
}

pir_state pir_critical_states_at_start(const pir_critical_states *states) {
    return states->at_start;
}

pir_status pir_critical_states_polynomial_exact(const pir_critical_states *states, uint32_t contact,
                                                mpz_t *ret_coefficients) {
    if (!states || !ret_coefficients || contact >= states->count)
        return PIR_ERR_ARGUMENT;
    for (size_t k = 0; k < 3; k++)
        mpz_set(ret_coefficients[k], states->polynomial[3 * (size_t)contact + k]);
    return PIR_OK;
}
