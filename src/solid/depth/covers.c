/* SPDX-License-Identifier: MIT */
/* See covers.h. The same sums cover one point after another, so those that did so last are asked first. */
#include "solid/depth/covers.h"

#include <math.h>

bool pir_covers_init(pir_covers *covers, pir_obstacle *obstacle) {
    const pir_compound *p = obstacle->frame.body[0].of;
    const double unit = ldexp(1, -obstacle->frame.exponent);
    covers->obstacle = obstacle;
    covers->ball = PIR_ZEROED(&obstacle->allocator, pir_cover_ball, p->count);
    for (uint32_t i = 0; i < p->count && covers->ball; i++) {
        pir_cover_ball *ball = &covers->ball[i];
        const uint32_t first = p->vertex_start[i], end = p->vertex_start[i + 1];
        double low[3] = {0}, high[3] = {0}, square = 0;
        for (uint32_t v = first; v < end; v++) {
            const double *x = p->vertex[v];
            for (int k = 0; k < 3; k++) {
                low[k] = v == first || x[k] < low[k] ? x[k] : low[k];
                high[k] = v == first || x[k] > high[k] ? x[k] : high[k];
                ball->middle[k] = unit * (low[k] / 2 + high[k] / 2);
            }
        }
        for (uint32_t v = first; v < end; v++) {
            const double *x = p->vertex[v];
            double own = 0;
            for (int k = 0; k < 3; k++)
                own += (unit * x[k] - ball->middle[k]) * (unit * x[k] - ball->middle[k]);
            square = fmax(square, own);
        }
        ball->radius = sqrt(square) * (1 + 0x1p-48) + 0x1p-46;
    }
    return covers->ball != NULL;
}

void pir_covers_finish(pir_covers *covers) {
    if (covers->ball)
        PIR_FREE(&covers->obstacle->allocator, covers->ball, covers->obstacle->frame.body[0].of->count);
}

/* How far a point of one pair's piece of P may be from one of another's, by their balls. */
static double between(const pir_covers *c, uint32_t pair, uint32_t other) {
    const uint32_t of_q = c->obstacle->frame.body[1].of->count;
    const pir_cover_ball *a = &c->ball[pair / of_q], *b = &c->ball[other / of_q];
    const double to[3] = {b->middle[0] - a->middle[0], b->middle[1] - a->middle[1], b->middle[2] - a->middle[2]};
    return a->radius + b->radius + sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
}

double pir_covers_margin(const pir_covers *covers, const pir_cover_need *need, uint32_t cover) {
    return need->margin + (need->turn > 0 ? need->turn * between(covers, need->pair, cover) : 0);
}

/* Makes a pair the first of those that have covered points of late. */
static void note(pir_covers *c, uint32_t pair) {
    uint32_t at = 0;
    while (at < c->count && c->late[at] != pair)
        at++;
    if (at == c->count && c->count < PIR_COVERS_LATE)
        c->count++;
    at = at < PIR_COVERS_LATE ? at : PIR_COVERS_LATE - 1;
    for (; at > 0; at--)
        c->late[at] = c->late[at - 1];
    c->late[0] = pair;
}

/* Whether a place may be in the sum of two boxes. */
static inline bool boxes_hold(const pir_space_box *a, const pir_space_box *b, const double x[3], double room) {
    for (int k = 0; k < 3; k++)
        if (x[k] < a->low[k] + b->low[k] - room || x[k] > a->high[k] + b->high[k] + room)
            return false;
    return true;
}

/* How deep a place is in a sum at least, by doubles; below 0 where that is not known. `err`: of the place. */
static double depth_by_doubles(pir_obstacle *o, pir_obstacle_sum *sum, const double x[3], double err) {
    const pir_obstacle_plane *first = &o->plane[sum->first], *late = &o->plane[sum->outer];
    if (late->d - (late->n[0] * x[0] + late->n[1] * x[1] + late->n[2] * x[2]) < 0)
        return -1;
    double least = HUGE_VAL;
    for (const pir_obstacle_plane *f = first; f < first + sum->count; f++) {
        const double s = f->d - (f->n[0] * x[0] + f->n[1] * x[1] + f->n[2] * x[2]);
        const double bound = f->err + err + 0x1p-50, slack = s - bound;
        least = slack < least ? slack : least;
        if (slack <= 0) {
            sum->outer = (uint32_t)(f - o->plane);
            if (s < -bound)
                pir_obstacle_note_beyond(o, sum->outer);
            return -1;
        }
    }
    return least;
}

/* How deep a point is in a sum at least, where it is inside of it; below 0 where it is not. */
static double depth_within(pir_obstacle *o, const pir_obstacle_sum *sum, uint32_t point) {
    const pir_obstacle_point p = o->point[point];
    double least = HUGE_VAL;
    bool sure = true;
    for (int k = 0; k < 3 && p.kind != PIR_OBSTACLE_VERTICES; k++)
        if (p.of[k] != PIR_OBSTACLE_NONE && p.of[k] - sum->first < sum->count)
            return -1;
    for (uint32_t f = sum->first; f < sum->first + sum->count; f++) {
        const pir_obstacle_plane *plane = &o->plane[f];
        const double s = plane->d - (plane->n[0] * p.x[0] + plane->n[1] * p.x[1] + plane->n[2] * p.x[2]);
        const double bound = plane->err + p.err + 0x1p-50;
        if (s < -bound) {
            pir_obstacle_note_beyond(o, f);
            return -1;
        }
        sure = sure && s > bound;
        least = s - bound < least ? s - bound : least;
    }
    for (uint32_t f = sum->first; f < sum->first + sum->count && !sure; f++)
        if (pir_obstacle_side(o, f, point) >= 0)
            return -1;
    return least > 0 ? least : 0;
}

/* A sum of late that a place is inside of by doubles, as deep as it needs to be: the one with most to spare. */
static uint32_t late_cover(pir_covers *c, const pir_cover_need *need, const double x[3], double err) {
    double most = 0;
    uint32_t best = PIR_OBSTACLE_NONE;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t pair = c->late[i];
        const double depth = depth_by_doubles(c->obstacle, pir_obstacle_open(c->obstacle, pair), x, err);
        const double spare = depth > 0 ? depth - pir_covers_margin(c, need, pair) : 0;
        if (spare > most) {
            most = spare;
            best = pair;
        }
    }
    return best;
}

/* A sum that holds a place so deep is as good as the deepest. */
#define WELL_INSIDE 0x1p-6

/* The pair in whose sum a place is deepest inside, or none: of a point, exactly, or, without one, by doubles, as deep
 * as it needs to be. */
static uint32_t deepest_cover(pir_covers *c, const pir_cover_need *need, const double x[3], double err,
                              uint32_t point) {
    pir_obstacle *o = c->obstacle;
    const pir_framed_body *p = &o->frame.body[0], *q = &o->frame.body[1];
    const double room = err + 0x1p-46;
    uint32_t best = PIR_OBSTACLE_NONE;
    double deepest = -1;
    for (uint32_t i = 0; i < p->of->count; i++) {
        if (!boxes_hold(&p->box[i], &q->whole, x, room))
            continue;
        for (uint32_t j = 0; j < q->of->count && o->status == PIR_OK; j++) {
            const uint32_t pair = i * q->of->count + j;
            if (!boxes_hold(&p->box[i], &q->box[j], x, room) || pir_obstacle_is_beyond(o, pair, x, err))
                continue;
            pir_obstacle_sum *sum = pir_obstacle_open(o, pair);
            if (o->status != PIR_OK)
                break;
            const double depth =
                point == PIR_OBSTACLE_NONE ? depth_by_doubles(o, sum, x, err) : depth_within(o, sum, point);
            if (depth > deepest && (point != PIR_OBSTACLE_NONE || depth > pir_covers_margin(c, need, pair))) {
                deepest = depth;
                best = pair;
            }
            if (deepest > WELL_INSIDE)
                return best;
        }
    }
    return best;
}

uint32_t pir_covers_of(pir_covers *covers, uint32_t point) {
    static const pir_cover_need inside = {0};
    const pir_obstacle_point at = covers->obstacle->point[point];
    uint32_t cover = late_cover(covers, &inside, at.x, at.err);
    if (cover == PIR_OBSTACLE_NONE)
        cover = deepest_cover(covers, &inside, at.x, at.err, point);
    if (cover != PIR_OBSTACLE_NONE)
        note(covers, cover);
    return cover;
}

uint32_t pir_covers_about(pir_covers *covers, const pir_cover_need *need, uint32_t guess, const double x[3]) {
    pir_obstacle *o = covers->obstacle;
    const double err = 0x1p-46;
    if (guess != PIR_OBSTACLE_NONE &&
        depth_by_doubles(o, pir_obstacle_open(o, guess), x, err) > pir_covers_margin(covers, need, guess))
        return guess;
    uint32_t cover = late_cover(covers, need, x, err);
    if (cover == PIR_OBSTACLE_NONE)
        cover = deepest_cover(covers, need, x, err, PIR_OBSTACLE_NONE);
    if (cover != PIR_OBSTACLE_NONE)
        note(covers, cover);
    return cover;
}

/* How deep all of some places are inside of a sum at least, by doubles; 0 where that is not known. */
static double depth_of_all(const pir_obstacle *o, pir_obstacle_sum *sum, uint32_t count, const double (*x)[3]) {
    const pir_obstacle_plane *first = &o->plane[sum->first], *late = &o->plane[sum->outer];
    if (late->d - (late->n[0] * x[0][0] + late->n[1] * x[0][1] + late->n[2] * x[0][2]) < 0)
        return 0;
    double least = HUGE_VAL;
    for (const pir_obstacle_plane *f = first; f < first + sum->count; f++) {
        const double most = f->d - f->err - 0x1p-46;
        for (uint32_t i = 0; i < count; i++) {
            const double s = most - (f->n[0] * x[i][0] + f->n[1] * x[i][1] + f->n[2] * x[i][2]);
            least = s < least ? s : least;
        }
        if (!(least > 0)) {
            sum->outer = (uint32_t)(f - o->plane);
            return 0;
        }
    }
    return least;
}

double pir_covers_all(pir_covers *covers, uint32_t own, double enough, uint32_t *guess, uint32_t count,
                      const double (*x)[3]) {
    pir_obstacle *o = covers->obstacle;
    double turn = 0;
    const uint32_t first = *guess;
    if (count > 0 && first != PIR_OBSTACLE_NONE)
        turn = depth_of_all(o, pir_obstacle_open(o, first), count, x) / between(covers, own, first);
    for (uint32_t i = 0; i < covers->count && count > 0 && !(turn > enough); i++) {
        const uint32_t cover = covers->late[i];
        if (cover == own || cover == first || o->sum[cover].count == 0)
            continue;
        const double depth = depth_of_all(o, &o->sum[cover], count, x);
        if (depth > 0 && depth > turn * between(covers, own, cover)) {
            turn = depth / between(covers, own, cover);
            *guess = cover;
        }
    }
    if (turn > 0)
        note(covers, *guess);
    return turn;
}
