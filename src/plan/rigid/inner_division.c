/* SPDX-License-Identifier: MIT */
/* See inner_division.h. */
#include "plan/rigid/inner_division.h"

#include <stdlib.h>
#include <string.h>

#include "plan/rigid/inner_sums.h"

/* Into how many parts a piece of a way is divided for points that are looked at. */
#define STEPS 8

/* How many points about a deepest one are looked at. */
#define NEARS 48

/* How many points are added to sums at a time. */
#define MOST_POINTS 24

struct sum_choice {
    const pir_rigid_question *question;
    pir_inner_search *search;
    pir_plan_pieces *sums;
    pir_box_division *division;
    pir_inner_list *list;
    bool *used;          /* per pair */
    pir_polytope **base; /* per sum: before points made it wider */
    uint32_t *wide;      /* how many points did */
    uint32_t pairs, best;
    double depth, deepest[3];
    double size;       /* of the robot */
    double (*near)[3]; /* points about the deepest ones of all ways */
    uint32_t nears, room;
};

static double size_of(const pir_plan_pieces *robot) {
    double size = 0;
    for (uint32_t k = 0; k < robot->count; k++) {
        pir_vec3 low, high;
        pir_polytope_bounds(robot->at[k], &low, &high);
        size = fmax(size, fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z)));
    }
    return size;
}

static void mean_of(const pir_box_division *division, uint32_t cell, double ret[3]) {
    const pir_plan_cell *own = &division->tree.cell[cell];
    for (int k = 0; k < 3; k++) {
        ret[k] = 0;
        for (uint32_t v = 0; v < own->points; v++)
            ret[k] += division->space.point[own->point[v]].at[k] / own->points;
    }
}

/* Whether a translation is in a sum. */
static bool is_blocked(const struct sum_choice *c, const double x[3]) {
    for (uint32_t i = 0; i < c->sums->count; i++) {
        const pir_polytope *made = c->sums->at[i];
        bool has = true;
        for (uint32_t f = 0; f < pir_polytope_facet_count(made) && has; f++) {
            uint32_t corner[PIR_INNER_CORNERS + PIR_INNER_MORE];
            const pir_vec3 n = pir_polytope_normal(made, f);
            pir_polytope_facet(made, f, corner);
            const pir_vec3 v = pir_polytope_vertex(made, corner[0]);
            has = n.x * (x[0] - v.x) + n.y * (x[1] - v.y) + n.z * (x[2] - v.z) <= 0;
        }
        if (has)
            return true;
    }
    return false;
}

/* Looks at points between two for the pair that has one deepest. */
static void look_along(struct sum_choice *c, const double a[3], const double b[3]) {
    for (int i = 0; i <= STEPS; i++) {
        const double s = (double)i / STEPS;
        const double x[3] = {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
        for (uint32_t p = 0; p < c->pairs; p++) {
            const double depth = c->used[p] ? 0 : pir_inner_depth(c->search, p, x);
            if (depth > c->depth && pir_inner_has(c->search, p, x)) {
                c->depth = depth;
                c->best = p;
                memcpy(c->deepest, x, sizeof x);
            }
        }
    }
}

/* By which joint each cell is reached from one, or none. */
static void reach(const pir_box_division *division, uint32_t from, uint32_t *by) {
    const pir_plan_joints *joints = &division->joints;
    memset(by, 0xff, joints->cells * sizeof *by);
    // joints are a forest, and few
    for (bool more = true; more;) {
        more = false;
        for (uint32_t i = 0; i < joints->count; i++)
            for (int s = 0; s < 2; s++) {
                const uint32_t a = joints->joint[i].cell[s], b = joints->joint[i].cell[1 - s];
                if (b != from && by[b] == PIR_PLAN_NONE && (a == from || by[a] != PIR_PLAN_NONE)) {
                    by[b] = i;
                    more = true;
                }
            }
    }
}

/* Looks along the way between two cells. */
static pir_status look_at_way(struct sum_choice *c, const uint32_t cell[2]) {
    const pir_plan_joints *joints = &c->division->joints;
    pir_plan_space *space = &c->division->space;
    uint32_t *by = pir_plan_new(space, joints->cells, sizeof *by), now = cell[1];
    double last[3], next[3];
    if (!by)
        return space->status;
    c->best = PIR_PLAN_NONE;
    c->depth = 0;
    reach(c->division, cell[0], by);
    memcpy(last, c->question->at[1], sizeof last);
    for (; now != cell[0]; memcpy(last, next, sizeof last)) {
        mean_of(c->division, now, next);
        look_along(c, last, next);
        const uint32_t *of = joints->joint[by[now]].cell;
        now = of[0] == now ? of[1] : of[0];
    }
    if (cell[0] != cell[1]) {
        mean_of(c->division, now, next);
        look_along(c, last, next);
        memcpy(last, next, sizeof last);
    }
    look_along(c, last, c->question->at[0]);
    pir_plan_free(space, by, joints->cells, sizeof *by);
    return PIR_OK;
}

/* --- sums --- */

/* Grows an array of a list's, from malloc. */
static pir_status grow_list(void **array, uint32_t need, size_t size) {
    void *grown = realloc(*array, need * size);
    *array = grown ? grown : *array;
    return grown ? PIR_OK : PIR_ERR_MEMORY;
}

/* Makes the sum of a pair, which is listed. */
static pir_status make_sum(struct sum_choice *c, uint32_t pair) {
    c->used[pair] = true;
    const uint32_t number = c->sums->count;
    const pir_status status = pir_inner_sum_make(c->search, pair, &c->base[number]);
    if (c->base[number]) {
        c->sums->at[number] = pir_polytope_retain(c->base[number]);
        c->sums->body[c->sums->count++] = pair;
    }
    return status;
}

/* Adds a pair to the list, with its sum. */
static pir_status add_pair(struct sum_choice *c, uint32_t pair) {
    pir_inner_list *list = c->list;
    const pir_status status = grow_list((void **)&list->pair, list->pairs + 1, sizeof *list->pair);
    if (status != PIR_OK)
        return status;
    list->pair[list->pairs++] = pair;
    return make_sum(c, pair);
}

/* Has a sum be as wide as the points of the list make it. */
static pir_status widen(struct sum_choice *c, uint32_t number) {
    pir_vec3 more[PIR_INNER_MORE];
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->list->points && count < PIR_INNER_MORE; i++)
        if (c->list->point[i].pair == c->sums->body[number])
            more[count++] = c->list->point[i].at;
    pir_polytope *wider = NULL;
    const pir_status status = count > 0 ? pir_inner_sum_widen(c->search, c->base[number], more, count, &wider) : PIR_OK;
    if (wider) {
        pir_polytope_release(c->sums->at[number]);
        c->sums->at[number] = wider;
    }
    c->wide[number] = count;
    return status;
}

/* The free cell that has an end's translation, or none. */
static uint32_t cell_of(struct sum_choice *c, int end) {
    pir_box_division *d = c->division;
    const uint32_t point = pir_plan_point_at(&d->space, c->question->at[end]);
    for (uint32_t i = 0; i < d->tree.cell_count && d->space.status == PIR_OK; i++)
        if (pir_plan_cell_has(&d->space, &d->tree.cell[i], point))
            return i;
    return PIR_PLAN_NONE;
}

/* Adds points about the deepest one of a way: of a lattice that fills a ball. */
static bool add_near(struct sum_choice *c) {
    if (!pir_plan_grow(&c->division->space, (void **)&c->near, &c->room, c->nears + NEARS, sizeof *c->near))
        return false;
    for (int i = 0; i < NEARS; i++) {
        // the fractional parts of multiples of roots of x^4 = x + 1 are even in the cube
        const double part[3] = {fmod((i + 1) * 0.8191725134, 1), fmod((i + 1) * 0.6710436067, 1),
                                fmod((i + 1) * 0.5497004779, 1)};
        for (int k = 0; k < 3; k++)
            c->near[c->nears][k] = c->deepest[k] + c->size * (part[k] - 0.5);
        c->nears++;
    }
    return true;
}

/* Adds pairs that have points which no sum has yet, those of most points first. `has` is per point and pair. */
static pir_status add_most(struct sum_choice *c, const double (*x)[3], uint32_t count, bool *has, uint32_t *counts) {
    const uint32_t pairs = c->pairs;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t p = 0, is_free = !is_blocked(c, x[i]); p < pairs && is_free; p++) {
            has[i * pairs + p] =
                !c->used[p] && pir_inner_depth(c->search, p, x[i]) > 0 && pir_inner_has(c->search, p, x[i]);
            counts[p] += has[i * pairs + p];
        }
    while (status == PIR_OK) {
        uint32_t best = 0;
        for (uint32_t p = 1; p < pairs; p++)
            best = counts[p] > counts[best] ? p : best;
        if (counts[best] == 0)
            break;
        status = add_pair(c, best);
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t p = 0; has[i * pairs + best] && p < pairs; p++) {
                if (p == best)
                    continue;
                counts[p] -= has[i * pairs + p];
                has[i * pairs + p] = false;
            }
        counts[best] = 0;
    }
    return status;
}

static pir_status add_blocking(struct sum_choice *c, const double (*x)[3], uint32_t count) {
    pir_plan_space *space = &c->division->space;
    const size_t all = (size_t)count * c->pairs;
    bool *has = pir_plan_new(space, all, sizeof *has);
    uint32_t *counts = pir_plan_new(space, c->pairs, sizeof *counts);
    const pir_status status = space->status == PIR_OK ? add_most(c, x, count, has, counts) : space->status;
    pir_plan_free(space, has, all, sizeof *has);
    pir_plan_free(space, counts, c->pairs, sizeof *counts);
    return status;
}

/* Adds a point to the list, which makes a sum wider; none where rounding puts it outside. */
static pir_status add_point(struct sum_choice *c, uint32_t number, const double x[3], bool *ret_is_added) {
    pir_inner_list *list = c->list;
    pir_inner_point point = {.pair = c->sums->body[number]};
    *ret_is_added = pir_inner_sum_point(c->search, point.pair, c->sums->at[number], x, &point.at);
    if (!*ret_is_added)
        return PIR_OK;
    const pir_status status = grow_list((void **)&list->point, list->points + 1, sizeof *list->point);
    if (status != PIR_OK)
        return status;
    list->point[list->points++] = point;
    return widen(c, number);
}

/* Widens sums by points that no sum has, as many as may be: each time by the one that is farthest from a sum whose pair
 * has it. `has` is per point and sum. */
static pir_status add_farthest(struct sum_choice *c, const double (*x)[3], uint32_t count, bool *has) {
    const uint32_t sums = c->sums->count;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0, is_free = !is_blocked(c, x[i]); k < sums && is_free; k++)
            has[i * sums + k] = pir_inner_depth(c->search, c->sums->body[k], x[i]) > 0 &&
                                pir_inner_has(c->search, c->sums->body[k], x[i]);
    for (int n = 0; n < MOST_POINTS && status == PIR_OK; n++) {
        uint32_t at = 0, best = sums;
        double most = 0;
        for (uint32_t i = 0; i < count; i++) {
            double least = INFINITY;
            uint32_t of = sums;
            for (uint32_t k = 0; k < sums && least > 0; k++) {
                const double far = has[i * sums + k] ? pir_inner_sum_far(c->sums->at[k], x[i]) : INFINITY;
                of = far < least && c->wide[k] < PIR_INNER_MORE ? k : of;
                least = fmin(least, far);
            }
            if (of < sums && least > most) {
                most = least;
                best = of;
                at = i;
            }
        }
        if (best == sums)
            break;
        status = add_point(c, best, x[at], &has[at * sums + best]);
    }
    return status;
}

static pir_status add_points(struct sum_choice *c, const double (*x)[3], uint32_t count) {
    pir_plan_space *space = &c->division->space;
    const size_t all = (size_t)count * c->sums->count;
    bool *has = pir_plan_new(space, all, sizeof *has);
    const pir_status status = space->status == PIR_OK ? add_farthest(c, x, count, has) : space->status;
    pir_plan_free(space, has, all, sizeof *has);
    return status;
}

/* Divides by the sums from one on. */
static pir_status divide_by(struct sum_choice *c, uint32_t first) {
    pir_status status = PIR_OK;
    if (c->sums->count > first || c->division->tree.node_count == 0)
        status = pir_box_division_add(c->question, c->sums, first, c->division);
    return status == PIR_OK ? pir_box_division_join(false, c->division) : status;
}

/* Makes sums of pairs that have points near ways which no sum has yet. */
static pir_status thicken(struct sum_choice *c) {
    const uint32_t first = c->sums->count;
    const pir_status status = add_blocking(c, (const double(*)[3])c->near, c->nears);
    return status == PIR_OK ? divide_by(c, first) : status;
}

/* Makes the sums of all pairs. */
static pir_status add_all(struct sum_choice *c) {
    const uint32_t first = c->sums->count;
    pir_status status = PIR_OK;
    for (uint32_t p = 0; p < c->pairs && status == PIR_OK; p++)
        if (!c->used[p])
            status = add_pair(c, p);
    return status == PIR_OK ? divide_by(c, first) : status;
}

static pir_status choose(struct sum_choice *c) {
    pir_status status = divide_by(c, 0);
    while (status == PIR_OK) {
        const uint32_t first = c->sums->count;
        const uint32_t cell[2] = {cell_of(c, 0), cell_of(c, 1)};
        if (cell[0] == PIR_PLAN_NONE || cell[1] == PIR_PLAN_NONE)
            return add_all(c);
        if (c->division->joints.root[cell[0]] != c->division->joints.root[cell[1]])
            return thicken(c);
        status = look_at_way(c, cell);
        if (status != PIR_OK || c->best == PIR_PLAN_NONE)
            break;
        status = add_near(c) ? add_pair(c, c->best) : c->division->space.status;
        if (status == PIR_OK)
            status = divide_by(c, first);
    }
    return status;
}

/* Whether a list is one that was made here: it may be a journal's. */
static pir_status check_list(struct sum_choice *c) {
    const pir_inner_list *list = c->list;
    bool good = true;
    for (uint32_t i = 0; i < list->pairs; i++)
        for (uint32_t k = 0; k < i; k++)
            good = good && list->pair[i] != list->pair[k];
    for (uint32_t i = 0; i < list->points && good; i++) {
        const pir_vec3 x = list->point[i].at;
        good = pir_inner_has(c->search, list->point[i].pair, (const double[]){x.x, x.y, x.z});
    }
    return good ? PIR_OK : PIR_ERR_FORMAT;
}

/* Makes the sums of the list and more for translations that none has, and divides by all at once. */
static pir_status take_list(struct sum_choice *c, const double (*x)[3], uint32_t count) {
    pir_status status = check_list(c);
    for (uint32_t i = 0; i < c->list->pairs && status == PIR_OK; i++)
        status = make_sum(c, c->list->pair[i]);
    for (uint32_t i = 0; i < c->sums->count && status == PIR_OK && c->list->points > 0; i++)
        status = widen(c, i);
    if (status == PIR_OK && count > 0)
        status = add_blocking(c, x, count);
    if (status == PIR_OK && count > 0)
        status = add_points(c, x, count);
    return status == PIR_OK ? divide_by(c, 0) : status;
}

static pir_status open_choice(struct sum_choice *c, const pir_plan_turns *turns) {
    pir_plan_space *space = &c->division->space;
    c->pairs = c->question->robot->count * c->question->wide->count;
    *c->sums =
        (pir_plan_pieces){.at = calloc(c->pairs, sizeof *c->sums->at), .body = calloc(c->pairs, sizeof *c->sums->body)};
    const pir_status status = pir_box_division_open(c->question, c->division);
    if (status != PIR_OK || !c->sums->at || !c->sums->body)
        return status != PIR_OK ? status : PIR_ERR_MEMORY;
    c->used = pir_plan_new(space, c->pairs, sizeof *c->used);
    c->base = pir_plan_new(space, c->pairs, sizeof *c->base);
    c->wide = pir_plan_new(space, c->pairs, sizeof *c->wide);
    return space->status == PIR_OK ? pir_inner_search_open(c->question, turns, space, &c->search) : space->status;
}

static void close_choice(struct sum_choice *c) {
    pir_plan_space *space = &c->division->space;
    for (uint32_t i = 0; i < c->sums->count; i++)
        pir_polytope_release(c->base[i]);
    pir_inner_search_close(c->search);
    pir_plan_free(space, c->near, c->room, sizeof *c->near);
    pir_plan_free(space, c->used, c->used ? c->pairs : 0, sizeof *c->used);
    pir_plan_free(space, c->base, c->base ? c->pairs : 0, sizeof *c->base);
    pir_plan_free(space, c->wide, c->wide ? c->pairs : 0, sizeof *c->wide);
}

pir_status pir_inner_division_make(const pir_rigid_question *question, const pir_plan_turns *turns,
                                   const double (*x)[3], uint32_t count, pir_inner_list *list,
                                   pir_plan_pieces *ret_sums, pir_box_division *ret_division) {
    struct sum_choice c = {.question = question,
                           .sums = ret_sums,
                           .division = ret_division,
                           .list = list,
                           .size = size_of(question->robot)};
    pir_status status = open_choice(&c, turns);
    if (status == PIR_OK)
        status = list->rounds > 0 ? take_list(&c, x, count) : choose(&c);
    close_choice(&c);
    return status;
}

pir_status pir_inner_division_again(const pir_rigid_question *question, const pir_plan_turns *turns,
                                    const pir_inner_list *list, pir_plan_pieces *ret_sums,
                                    pir_box_division *ret_division) {
    pir_inner_list again = {.rounds = list->rounds};
    if (list->rounds > 0)
        again = *list;
    const pir_status status = pir_inner_division_make(question, turns, NULL, 0, &again, ret_sums, ret_division);
    if (list->rounds == 0)
        pir_inner_list_finish(&again);
    return status;
}

/* --- lists --- */

bool pir_inner_list_copy(const pir_inner_list *list, pir_inner_list *ret_list) {
    pir_inner_list copy = *list;
    copy.pair = calloc((size_t)list->pairs + 1, sizeof *copy.pair);
    copy.point = calloc((size_t)list->points + 1, sizeof *copy.point);
    *ret_list = copy;
    if (!copy.pair || !copy.point)
        return false;
    if (list->pairs > 0)
        memcpy(copy.pair, list->pair, list->pairs * sizeof *copy.pair);
    if (list->points > 0)
        memcpy(copy.point, list->point, list->points * sizeof *copy.point);
    return true;
}

void pir_inner_list_finish(pir_inner_list *list) {
    free(list->pair);
    free(list->point);
    *list = (pir_inner_list){0};
}

size_t pir_inner_list_size(const pir_inner_list *list) {
    return list->pairs * sizeof *list->pair + list->points * sizeof *list->point;
}

/* Lists begin with this, pairs follow, then points as packed ones. */
struct packed_list {
    uint32_t pairs, points, rounds, none;
};

struct packed_point {
    double at[3];
    uint64_t pair;
};

bool pir_inner_list_pack(const pir_inner_list *list, pir_bytes *bytes) {
    const struct packed_list head = {list->pairs, list->points, list->rounds, 0};
    const pir_allocator a = pir_allocator_or_default(NULL);
    const size_t of_pairs = list->pairs * sizeof *list->pair;
    if (!pir_bytes_reserve(bytes, &a, sizeof head + of_pairs + list->points * sizeof(struct packed_point)))
        return false;
    memcpy(bytes->data + bytes->used, &head, sizeof head);
    bytes->used += sizeof head;
    if (of_pairs > 0)
        memcpy(bytes->data + bytes->used, list->pair, of_pairs);
    bytes->used += of_pairs;
    for (uint32_t i = 0; i < list->points; i++) {
        const pir_vec3 x = list->point[i].at;
        const struct packed_point packed = {{x.x, x.y, x.z}, list->point[i].pair};
        memcpy(bytes->data + bytes->used, &packed, sizeof packed);
        bytes->used += sizeof packed;
    }
    return true;
}

bool pir_inner_list_unpack(pir_bytes *bytes, uint32_t pairs, pir_inner_list *list) {
    struct packed_list head;
    *list = (pir_inner_list){0};
    if (bytes->used < sizeof head)
        return false;
    memcpy(&head, bytes->data, sizeof head);
    const size_t of_pairs = head.pairs * sizeof *list->pair, of_points = head.points * sizeof(struct packed_point);
    if (head.pairs > pairs || bytes->used - sizeof head < of_pairs + of_points)
        return false;
    list->pair = calloc((size_t)head.pairs + 1, sizeof *list->pair);
    list->point = calloc((size_t)head.points + 1, sizeof *list->point);
    if (!list->pair || !list->point)
        return false;
    const uint8_t *at = bytes->data + sizeof head;
    if (of_pairs > 0)
        memcpy(list->pair, at, of_pairs);
    at += of_pairs;
    bool good = true;
    for (uint32_t i = 0; i < head.pairs; i++)
        good = good && list->pair[i] < pairs;
    for (uint32_t i = 0; i < head.points; i++, at += sizeof(struct packed_point)) {
        struct packed_point packed;
        memcpy(&packed, at, sizeof packed);
        good = good && packed.pair < pairs;
        list->point[i] = (pir_inner_point){{packed.at[0], packed.at[1], packed.at[2]}, (uint32_t)packed.pair};
    }
    list->pairs = head.pairs;
    list->points = head.points;
    list->rounds = head.rounds;
    const size_t taken = (size_t)(at - bytes->data);
    *bytes = (pir_bytes){bytes->data + taken, bytes->used - taken, bytes->used - taken};
    return good;
}
