/* SPDX-License-Identifier: MIT */
/* See boxes.h. The tree is complete: its leaves are as many as the least power of two that four boxes each fill. */
#include "solid/space/boxes.h"

#define LEAF PIR_BOXES_LEAF

void pir_space_box_add(pir_space_box *box, const pir_space_point *point) {
    for (int k = 0; k < 3; k++) {
        const double low = point->x[k] - point->err, high = point->x[k] + point->err;
        box->low[k] = low < box->low[k] ? low : box->low[k];
        box->high[k] = high > box->high[k] ? high : box->high[k];
    }
}

static void join(pir_space_box *box, const pir_space_box *other) {
    for (int k = 0; k < 3; k++) {
        box->low[k] = other->low[k] < box->low[k] ? other->low[k] : box->low[k];
        box->high[k] = other->high[k] > box->high[k] ? other->high[k] : box->high[k];
    }
}

static double twice_middle(const pir_space_box *box, uint32_t i, int axis) {
    return box[i].low[axis] + box[i].high[axis];
}

static void swap(uint32_t *order, uint32_t a, uint32_t b) {
    const uint32_t kept = order[a];
    order[a] = order[b];
    order[b] = kept;
}

/* Puts the `half` boxes that are first along an axis before the others, by partitions about the middle of three. */
static void select_first(const pir_space_box *box, uint32_t *order, uint32_t count, uint32_t half, int axis) {
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const double a = twice_middle(box, order[low], axis), b = twice_middle(box, order[(low + high) / 2], axis);
        const double c = twice_middle(box, order[high], axis);
        const double by = a < b ? (b < c ? b : a < c ? c : a) : (a < c ? a : b < c ? c : b);
        uint32_t i = low, j = high;
        for (;;) {
            while (twice_middle(box, order[i], axis) < by)
                i++;
            while (twice_middle(box, order[j], axis) > by)
                j--;
            if (i >= j)
                break;
            swap(order, i++, j--);
        }
        // all up to j are no farther along than all beyond it
        if (half <= j)
            high = j;
        else if (j + 1 < half)
            low = j + 1;
        else
            return;
    }
}

/* Puts order[first .. first + count) into the leaves below `node`, halves along the longest side of their box. */
static void split(pir_boxes *boxes, const pir_space_box *box, uint32_t first, uint32_t count) {
    if (count <= LEAF)
        return;
    pir_space_box all = PIR_SPACE_BOX_EMPTY;
    for (uint32_t i = first; i < first + count; i++)
        join(&all, &box[boxes->order[i]]);
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (all.high[k] - all.low[k] > all.high[axis] - all.low[axis])
            axis = k;
    // a full left half: the leaves below it are a power of two
    uint32_t half = LEAF;
    while (2 * half < count)
        half *= 2;
    select_first(box, boxes->order + first, count, half, axis);
    split(boxes, box, first, half);
    split(boxes, box, first + half, count - half);
}

void pir_boxes_replace(pir_boxes *boxes, const pir_space_box *box) {
    const uint32_t count = boxes->count, leaves = boxes->leaf_count;
    for (uint32_t i = 0; i < count; i++)
        boxes->order[i] = i;
    split(boxes, box, 0, count);
    for (uint32_t k = boxes->node_count; k-- > 0;) {
        boxes->node[k] = PIR_SPACE_BOX_EMPTY;
        if (k + 1 < leaves) {
            join(&boxes->node[k], &boxes->node[2 * k + 1]);
            join(&boxes->node[k], &boxes->node[2 * k + 2]);
        }
        for (uint32_t i = k + 1 < leaves ? count : (k + 1 - leaves) * LEAF; i < count && i < (k + 2 - leaves) * LEAF;
             i++)
            join(&boxes->node[k], &box[boxes->order[i]]);
    }
    for (uint32_t i = 0; i < count; i++)
        boxes->box[i] = box[boxes->order[i]];
}

bool pir_boxes_init(pir_boxes *boxes, const pir_allocator *allocator, const pir_space_box *box, uint32_t count) {
    const pir_allocator *a = allocator;
    uint32_t leaves = 1;
    while (leaves * LEAF < count)
        leaves *= 2;
    *boxes = (pir_boxes){.count = count, .leaf_count = leaves, .node_count = 2 * leaves - 1};
    boxes->node = PIR_NEW(a, pir_space_box, boxes->node_count);
    boxes->box = PIR_NEW(a, pir_space_box, count);
    boxes->order = PIR_NEW(a, uint32_t, count);
    const bool done = boxes->node && boxes->box && boxes->order;
    if (done)
        pir_boxes_replace(boxes, box);
    else
        pir_boxes_finish(boxes, a);
    return done;
}

void pir_boxes_finish(pir_boxes *boxes, const pir_allocator *allocator) {
    PIR_FREE(allocator, boxes->node, boxes->node_count);
    PIR_FREE(allocator, boxes->box, boxes->count);
    PIR_FREE(allocator, boxes->order, boxes->count);
    *boxes = (pir_boxes){0};
}

uint32_t pir_boxes_find(const pir_boxes *boxes, const pir_space_box *box, uint32_t *ret_found) {
    uint32_t stack[64], depth = 0, found = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t k = stack[--depth];
        if (!pir_space_box_meets(&boxes->node[k], box))
            continue;
        if (k + 1 < boxes->leaf_count) {
            stack[depth++] = 2 * k + 2;
            stack[depth++] = 2 * k + 1;
            continue;
        }
        const uint32_t first = (k + 1 - boxes->leaf_count) * LEAF;
        for (uint32_t i = first; i < boxes->count && i < first + LEAF; i++)
            if (pir_space_box_meets(&boxes->box[i], box))
                ret_found[found++] = boxes->order[i];
    }
    return found;
}
