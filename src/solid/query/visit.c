/* SPDX-License-Identifier: MIT */
/*
 * See visit.h. Boxes of P are turned into the frame of Q, where the boxes round them are held against those of Q. The
 * distance between those, less what rounding may have added, is a lower bound of the distance of what is in them. Of
 * two nodes the larger one is divided, and the nearer half is looked at first.
 */
#include "solid/query/visit.h"

#include "base/vec.h"

struct visit {
    const pir_compound *p, *q;
    double turn[3][3], reach[3][3]; /* of P's frame into Q's, and its absolute values */
    double shift[3];
    double room; /* what bounds are off by, and the radii */
};

/* A node of each tree, or from `leaves` on a box, and how far apart they are at the least. */
struct place {
    uint32_t p, q;
    double apart;
};

static void begin(struct visit *v, const pir_pair_input *input) {
    const pir_pose place = pir_pose_compose(pir_pose_invert(input->pose_q), input->pose_p);
    const pir_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) {
        const pir_vec3 column = pir_pose_rotate(place, axis[k]);
        const double c[3] = {column.x, column.y, column.z};
        for (int i = 0; i < 3; i++) {
            v->turn[i][k] = c[i];
            v->reach[i][k] = fabs(c[i]);
        }
    }
    v->shift[0] = place.translation.x;
    v->shift[1] = place.translation.y;
    v->shift[2] = place.translation.z;
    const pir_vec3 p = input->pose_p.translation, q = input->pose_q.translation;
    v->room =
        0x1p-44 * (v->p->reach + v->q->reach + fabs(p.x) + fabs(p.y) + fabs(p.z) + fabs(q.x) + fabs(q.y) + fabs(q.z)) +
        input->radius_p + input->radius_q;
}

/* A lower bound of the distance between what is in two boxes. */
static double distance(const struct visit *v, const pir_box *p, const pir_box *q) {
    double middle[3], half[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = (p->low[k] + p->high[k]) / 2;
        half[k] = (p->high[k] - p->low[k]) / 2;
    }
    for (int i = 0; i < 3; i++) {
        double at = v->shift[i], by = 0;
        for (int k = 0; k < 3; k++) {
            at += v->turn[i][k] * middle[k];
            by += v->reach[i][k] * half[k];
        }
        const double gap = fmax(q->low[i] - at - by, at - by - q->high[i]);
        sum += gap > 0 ? gap * gap : 0;
    }
    return sqrt(sum) * (1 - 0x1p-48) - v->room;
}

static double length_of(const pir_box *box) {
    return box->high[0] - box->low[0] + box->high[1] - box->low[1] + box->high[2] - box->low[2];
}

static bool is_leaf(const pir_boxes *boxes, uint32_t node) {
    return node + 1 >= boxes->leaf_count;
}

static struct place place_of(const struct visit *v, uint32_t p, uint32_t q) {
    return (struct place){p, q, distance(v, &v->p->boxes.node[p], &v->q->boxes.node[q])};
}

/* Asks about the pairs of two leaves that are within a distance; how far pairs are of interest then. */
static double ask_leaves(const struct visit *v, const struct place *place, double within, pir_pair_asker *ask,
                         void *context) {
    const pir_boxes *p = &v->p->boxes, *q = &v->q->boxes;
    const uint32_t first_p = (place->p + 1 - p->leaf_count) * PIR_BOXES_LEAF;
    const uint32_t first_q = (place->q + 1 - q->leaf_count) * PIR_BOXES_LEAF;
    for (uint32_t i = first_p; i < p->count && i < first_p + PIR_BOXES_LEAF; i++)
        for (uint32_t j = first_q; j < q->count && j < first_q + PIR_BOXES_LEAF; j++)
            if (within >= 0 && distance(v, &p->box[i], &q->box[j]) <= within)
                within = ask(context, p->order[i], q->order[j]);
    return within;
}

void pir_visit_pairs(const pir_compound *p, const pir_compound *q, const pir_pair_input *input, double within,
                     pir_pair_asker *ask, void *context) {
    struct visit v = {.p = p, .q = q};
    struct place stack[128]; // a division replaces a place by two; trees are at most 31 deep
    uint32_t depth = 0;
    begin(&v, input);
    stack[depth++] = place_of(&v, 0, 0);
    while (depth > 0 && within >= 0) {
        const struct place place = stack[--depth];
        const bool leaf_p = is_leaf(&p->boxes, place.p), leaf_q = is_leaf(&q->boxes, place.q);
        if (place.apart > within)
            continue;
        if (leaf_p && leaf_q) {
            within = ask_leaves(&v, &place, within, ask, context);
            continue;
        }
        const bool of_p =
            leaf_q || (!leaf_p && length_of(&p->boxes.node[place.p]) > length_of(&q->boxes.node[place.q]));
        const struct place half[2] = {
            of_p ? place_of(&v, 2 * place.p + 1, place.q) : place_of(&v, place.p, 2 * place.q + 1),
            of_p ? place_of(&v, 2 * place.p + 2, place.q) : place_of(&v, place.p, 2 * place.q + 2)};
        const int nearer = half[1].apart < half[0].apart;
        stack[depth++] = half[1 - nearer];
        stack[depth++] = half[nearer];
    }
}
