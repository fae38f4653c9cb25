/* SPDX-License-Identifier: MIT */
/*
 * See visit.h. Boxes of P are turned into the frame of Q, where the boxes round them are held against those of Q, and
 * the other way round. The greater distance, less what rounding may have added, is a lower bound of the distance of
 * what is in them. Of two nodes the larger one is divided, and the nearer half is looked at first. A box meets several
 * of the other body, and is turned once a visit.
 */
#include "solid/query/visit.h"

#include "base/vec.h"

struct visit {
    const pir_compound *p, *q;
    const pir_relative *at;
    uint64_t number;
};

/* A node of each tree, or from `leaves` on a box, and how far apart they are at the least. */
struct tree_place {
    uint32_t p, q;
    double apart;
};

/* A box of a tree, by the number of its node, or of its box behind the nodes. */
static const pir_space_box *box_of(const pir_boxes *boxes, uint32_t number) {
    return number < boxes->node_count ? &boxes->node[number] : &boxes->box[number - boxes->node_count];
}

/* How far a box is from an interval of half a length about a middle, along an axis. */
static double gap_of(const pir_space_box *box, int axis, double middle, double half) {
    const double below = box->low[axis] - middle, above = middle - box->high[axis];
    const double gap = (below > above ? below : above) - half;
    return gap > 0 ? gap : 0;
}

/* A box of P in the frame of Q. */
static const pir_turned_box *turned_p(const struct visit *v, uint32_t number) {
    pir_turned_box *turned = &v->p->turned[number];
    if (turned->visit == v->number)
        return turned;
    const pir_space_box *box = box_of(&v->p->boxes, number);
    double middle[3], half[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = (box->low[k] + box->high[k]) / 2;
        half[k] = (box->high[k] - box->low[k]) / 2;
    }
    for (int i = 0; i < 3; i++) {
        const double *turn = v->at->turn[i], *reach = v->at->reach[i];
        turned->middle[i] = v->at->shift[i] + turn[0] * middle[0] + turn[1] * middle[1] + turn[2] * middle[2];
        turned->half[i] = reach[0] * half[0] + reach[1] * half[1] + reach[2] * half[2];
    }
    turned->visit = v->number;
    return turned;
}

/* A box of Q in the frame of P. */
static const pir_turned_box *turned_q(const struct visit *v, uint32_t number) {
    pir_turned_box *turned = &v->q->turned[number];
    if (turned->visit == v->number)
        return turned;
    const pir_space_box *box = box_of(&v->q->boxes, number);
    const double(*turn)[3] = (const double(*)[3])v->at->turn, (*reach)[3] = (const double(*)[3])v->at->reach;
    double middle[3], half[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = (box->low[k] + box->high[k]) / 2 - v->at->shift[k];
        half[k] = (box->high[k] - box->low[k]) / 2;
    }
    for (int i = 0; i < 3; i++) {
        turned->middle[i] = turn[0][i] * middle[0] + turn[1][i] * middle[1] + turn[2][i] * middle[2];
        turned->half[i] = reach[0][i] * half[0] + reach[1][i] * half[1] + reach[2][i] * half[2];
    }
    turned->visit = v->number;
    return turned;
}

/* A lower bound of the distance between what is in two boxes, as seen in the frame of Q, then in that of P: of less
 * use, but sooner known, once one axis shows that it is above `within`. */
static double distance(const struct visit *v, uint32_t p, uint32_t q, double within) {
    const double off = v->at->error + v->at->radii;
    double sum[2] = {0, 0};
    const pir_turned_box *of_p = turned_p(v, p), *of_q = turned_q(v, q);
    const pir_space_box *box_p = box_of(&v->p->boxes, p), *box_q = box_of(&v->q->boxes, q);
    for (int i = 0; i < 3; i++) {
        const double gap = gap_of(box_q, i, of_p->middle[i], of_p->half[i]);
        if (gap - off > within)
            return gap - off;
        sum[0] += gap * gap;
    }
    for (int i = 0; i < 3; i++) {
        const double gap = gap_of(box_p, i, of_q->middle[i], of_q->half[i]);
        if (gap - off > within)
            return gap - off;
        sum[1] += gap * gap;
    }
    const double most = sum[0] > sum[1] ? sum[0] : sum[1];
    return (most > 0 ? sqrt(most) * (1 - 0x1p-48) : 0) - off;
}

static double length_of(const pir_space_box *box) {
    return box->high[0] - box->low[0] + box->high[1] - box->low[1] + box->high[2] - box->low[2];
}

static bool is_leaf(const pir_boxes *boxes, uint32_t node) {
    return node + 1 >= boxes->leaf_count;
}

static struct tree_place place_of(const struct visit *v, uint32_t p, uint32_t q, double within) {
    return (struct tree_place){p, q, distance(v, p, q, within)};
}

/* Asks about the pairs of two leaves that are within a distance; how far pairs are of interest then. */
static double ask_leaves(const struct visit *v, const struct tree_place *place, double within, pir_pair_asker *ask,
                         void *context) {
    const pir_boxes *p = &v->p->boxes, *q = &v->q->boxes;
    const uint32_t first_p = (place->p + 1 - p->leaf_count) * PIR_BOXES_LEAF;
    const uint32_t first_q = (place->q + 1 - q->leaf_count) * PIR_BOXES_LEAF;
    for (uint32_t i = first_p; i < p->count && i < first_p + PIR_BOXES_LEAF && within >= 0; i++) {
        if (distance(v, p->node_count + i, place->q, within) > within)
            continue;
        for (uint32_t j = first_q; j < q->count && j < first_q + PIR_BOXES_LEAF && within >= 0; j++)
            if (distance(v, p->node_count + i, q->node_count + j, within) <= within)
                within = ask(context, p->order[i], q->order[j]);
    }
    return within;
}

void pir_visit_pairs(const pir_compound *p, const pir_compound *q, const pir_relative *relative, uint64_t number,
                     double within, pir_pair_asker *ask, void *context) {
    const struct visit v = {p, q, relative, number};
    struct tree_place stack[128]; // a division replaces a place by two; trees are at most 31 deep
    uint32_t depth = 0;
    stack[depth++] = place_of(&v, 0, 0, within);
    while (depth > 0 && within >= 0) {
        const struct tree_place place = stack[--depth];
        const bool leaf_p = is_leaf(&p->boxes, place.p), leaf_q = is_leaf(&q->boxes, place.q);
        if (place.apart > within)
            continue;
        if (leaf_p && leaf_q) {
            within = ask_leaves(&v, &place, within, ask, context);
            continue;
        }
        const bool of_p =
            leaf_q || (!leaf_p && length_of(&p->boxes.node[place.p]) > length_of(&q->boxes.node[place.q]));
        const struct tree_place half[2] = {
            of_p ? place_of(&v, 2 * place.p + 1, place.q, within) : place_of(&v, place.p, 2 * place.q + 1, within),
            of_p ? place_of(&v, 2 * place.p + 2, place.q, within) : place_of(&v, place.p, 2 * place.q + 2, within)};
        const int nearer = half[1].apart < half[0].apart;
        stack[depth++] = half[1 - nearer];
        stack[depth++] = half[nearer];
    }
}
