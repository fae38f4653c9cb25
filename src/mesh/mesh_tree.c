/* SPDX-License-Identifier: MIT */
/*
 * Making the tree, from the top: ranges of items are split where the surface area heuristic says, in 16 bins along each
 * axis (Wald, IEEE Symposium on Interactive Ray Tracing 2007), two or three splits a node. A range that is deep in the
 * tree, or that bins do not divide, is halved, so that the depth is bounded whatever the triangles are. Nothing
 * recurses.
 */
#include "mesh/mesh_tree.h"

#include <string.h>

#define BINS 16
/* From this depth on ranges are halved: 2^30 items take no more than 30 further levels. */
#define HALVE_FROM 30
/* Ranges of at most this many are split so that leaves are full. */
#define FEW 16

struct box {
    float low[3], high[3];
};

struct builder {
    const pir_allocator *allocator;
    const pir_mesh_source *source;
    pir_mesh_tree *tree;
    struct box *box; /* of each item, by place */
    uint32_t *item;
    uint32_t node_room;
};

struct triangle_range {
    uint32_t begin, end;
};

/* A range whose node is still to be made, and where its number goes. */
struct node_task {
    struct triangle_range range;
    uint32_t depth, parent, slot;
};

static const struct box nothing = {{HUGE_VALF, HUGE_VALF, HUGE_VALF}, {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF}};

static void join(struct box *to, const struct box *box) {
    for (int k = 0; k < 3; k++) {
        to->low[k] = box->low[k] < to->low[k] ? box->low[k] : to->low[k];
        to->high[k] = box->high[k] > to->high[k] ? box->high[k] : to->high[k];
    }
}

static float area_of(const struct box *box) {
    float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1], z = box->high[2] - box->low[2];
    return x * y + y * z + z * x;
}

static struct box box_of(const pir_mesh_source *source, uint32_t triangle) {
    struct box box = nothing;
    for (int i = 0; i < 3; i++) {
        const pir_vec3 *v = &source->vertex[source->corner[triangle][i]];
        const double c[3] = {v->x, v->y, v->z};
        for (int k = 0; k < 3; k++) {
            float under = pir_float_under(c[k]), over = pir_float_over(c[k]);
            box.low[k] = under < box.low[k] ? under : box.low[k];
            box.high[k] = over > box.high[k] ? over : box.high[k];
        }
    }
    return box;
}

static float middle(const struct box *box, int axis) {
    return 0.5f * (box->low[axis] + box->high[axis]);
}

static void swap_items(struct builder *b, uint32_t i, uint32_t j) {
    struct box box = b->box[i];
    b->box[i] = b->box[j];
    b->box[j] = box;
    uint32_t item = b->item[i];
    b->item[i] = b->item[j];
    b->item[j] = item;
}

/* --- splits --- */

struct middles {
    float low[3], high[3];
};

static struct middles middles_of(const struct builder *b, struct triangle_range range) {
    struct middles m = {{HUGE_VALF, HUGE_VALF, HUGE_VALF}, {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF}};
    for (uint32_t i = range.begin; i < range.end; i++)
        for (int k = 0; k < 3; k++) {
            float at = middle(&b->box[i], k);
            m.low[k] = at < m.low[k] ? at : m.low[k];
            m.high[k] = at > m.high[k] ? at : m.high[k];
        }
    return m;
}

static int widest(const struct middles *m) {
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (m->high[k] - m->low[k] > m->high[axis] - m->low[axis])
            axis = k;
    return axis;
}

/* Few items, in order along the widest axis, so that the first part fills its leaves. */
static uint32_t split_few(struct builder *b, struct triangle_range range) {
    struct middles m = middles_of(b, range);
    int axis = widest(&m);
    for (uint32_t i = range.begin + 1; i < range.end; i++)
        for (uint32_t j = i; j > range.begin && middle(&b->box[j], axis) < middle(&b->box[j - 1], axis); j--)
            swap_items(b, j, j - 1);
    uint32_t leaves = (range.end - range.begin + PIR_MESH_LEAF - 1) / PIR_MESH_LEAF;
    return range.begin + (leaves + 1) / 2 * PIR_MESH_LEAF;
}

static int bin_of(float at, float low, float scale) {
    int bin = (int)((at - low) * scale);
    return bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin;
}

struct split {
    int axis, bin; /* what is in `bin` and below goes first */
    float cost;
};

struct bins {
    struct box box[BINS];
    uint32_t count[BINS];
};

static float scale_of(const struct middles *m, int axis) {
    float extent = m->high[axis] - m->low[axis];
    // a scale that overflows would put all in one bin
    return extent > 0 && (float)BINS / extent < HUGE_VALF ? (float)BINS / extent : 0;
}

/* The best split along one axis, if it is better than `best`. */
static void try_axis(const struct bins *bins, int axis, struct split *best) {
    float cost_after[BINS];
    struct box box = nothing;
    uint32_t count = 0;
    for (int i = BINS - 1; i > 0; i--) {
        join(&box, &bins->box[i]);
        count += bins->count[i];
        cost_after[i] = count > 0 ? area_of(&box) * (float)count : HUGE_VALF;
    }
    box = nothing;
    count = 0;
    for (int i = 0; i + 1 < BINS; i++) {
        join(&box, &bins->box[i]);
        count += bins->count[i];
        float cost = count > 0 ? area_of(&box) * (float)count + cost_after[i + 1] : HUGE_VALF;
        if (cost < best->cost)
            *best = (struct split){axis, i, cost};
    }
}

static struct split best_split(const struct builder *b, struct triangle_range range, const struct middles *m) {
    struct split best = {-1, 0, HUGE_VALF};
    for (int axis = 0; axis < 3; axis++) {
        float scale = scale_of(m, axis);
        if (scale == 0)
            continue;
        struct bins bins = {.count = {0}};
        for (int i = 0; i < BINS; i++)
            bins.box[i] = nothing;
        for (uint32_t i = range.begin; i < range.end; i++) {
            int bin = bin_of(middle(&b->box[i], axis), m->low[axis], scale);
            join(&bins.box[bin], &b->box[i]);
            bins.count[bin]++;
        }
        try_axis(&bins, axis, &best);
    }
    return best;
}

/* Where a range of more than a leaf's items is divided: items change places. */
static uint32_t split(struct builder *b, struct triangle_range range, uint32_t depth) {
    if (range.end - range.begin <= FEW)
        return split_few(b, range);
    uint32_t half = range.begin + (range.end - range.begin) / 2;
    if (depth >= HALVE_FROM)
        return half;
    struct middles m = middles_of(b, range);
    struct split best = best_split(b, range, &m);
    if (best.axis < 0)
        return half;
    float scale = scale_of(&m, best.axis);
    uint32_t begin = range.begin, end = range.end;
    while (begin < end) {
        if (bin_of(middle(&b->box[begin], best.axis), m.low[best.axis], scale) <= best.bin)
            begin++;
        else
            swap_items(b, begin, --end);
    }
    return begin > range.begin && begin < range.end ? begin : half;
}

/* Divides a range for the children of one node; how many there are. */
static int divide(struct builder *b, struct triangle_range range, uint32_t depth,
                  struct triangle_range parts[PIR_MESH_WIDTH]) {
    int count = 1;
    parts[0] = range;
    while (count < PIR_MESH_WIDTH) {
        int largest = 0;
        for (int i = 1; i < count; i++)
            if (parts[i].end - parts[i].begin > parts[largest].end - parts[largest].begin)
                largest = i;
        struct triangle_range part = parts[largest];
        if (part.end - part.begin <= PIR_MESH_LEAF)
            break;
        uint32_t at = split(b, part, depth);
        memmove(&parts[largest + 1], &parts[largest], (size_t)(count - largest) * sizeof *parts);
        parts[largest].end = parts[largest + 1].begin = at;
        count++;
    }
    return count;
}

/* --- nodes --- */

/* The origin and the steps along an axis, so that 255 steps reach across. */
static void set_steps(pir_mesh_node *node, int axis, float low, float high) {
    node->origin[axis] = low;
    int exponent = -126;
    double extent = (double)high - (double)low;
    if (extent > 0)
        (void)frexp(extent / 255, &exponent);
    node->exponent[axis] = (int8_t)(exponent < -126 ? -126 : exponent);
    while (pir_mesh_bound(node, axis, 255) < high)
        node->exponent[axis]++;
}

static void set_child_box(pir_mesh_node *node, int child, const struct box *box) {
    for (int k = 0; k < 3; k++) {
        float step = pir_mesh_step(node->exponent[k]);
        int low = (int)((box->low[k] - node->origin[k]) / step), high = (int)((box->high[k] - node->origin[k]) / step);
        low = low > 255 ? 255 : low;
        high = high < 0 ? 0 : high > 255 ? 255 : high;
        while (low > 0 && pir_mesh_bound(node, k, (uint8_t)low) > box->low[k])
            low--;
        while (high < 255 && pir_mesh_bound(node, k, (uint8_t)high) < box->high[k])
            high++;
        node->low[k][child] = (uint8_t)low;
        node->high[k][child] = (uint8_t)high;
    }
}

static void set_no_child(pir_mesh_node *node, int child) {
    for (int k = 0; k < 3; k++) {
        node->low[k][child] = 255;
        node->high[k][child] = 0;
        node->normal[k][child] = k == 2;
    }
    node->child[child] = node->least[child] = PIR_MESH_NO_CHILD;
    node->slab_low[child] = HUGE_VALF;
    node->slab_high[child] = -HUGE_VALF;
}

/* The sum of the normals of the triangles of a range, or the normal of one of them where that is next to nothing. */
static pir_vec3 mean_normal(const struct builder *b, struct triangle_range range) {
    const pir_mesh_source *source = b->source;
    pir_vec3 sum = {0, 0, 0}, one = {0, 0, 1};
    double all = 0, most = 0;
    for (uint32_t i = range.begin; i < range.end; i++) {
        const uint32_t *c = source->corner[b->item[i]];
        const pir_vec3 *v = source->vertex;
        pir_vec3 n = pir_vec_cross(pir_vec_sub(v[c[1]], v[c[0]]), pir_vec_sub(v[c[2]], v[c[0]]));
        double length = fabs(n.x) + fabs(n.y) + fabs(n.z);
        sum = pir_vec_add(sum, n);
        all += length;
        if (length > most) {
            most = length;
            one = n;
        }
    }
    return fabs(sum.x) + fabs(sum.y) + fabs(sum.z) > 0.01 * all ? sum : one;
}

static void set_slab(const struct builder *b, pir_mesh_node *node, int child, struct triangle_range range) {
    pir_vec3 n = mean_normal(b, range);
    double length = fmax(fabs(n.x), fmax(fabs(n.y), fabs(n.z))), by = length > 1e-300 ? 127 / length : 0;
    const double d[3] = {rint(n.x * by), rint(n.y * by), by > 0 ? rint(n.z * by) : 127};
    for (int k = 0; k < 3; k++)
        node->normal[k][child] = (int8_t)d[k];
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (uint32_t i = range.begin; i < range.end; i++)
        for (int j = 0; j < 3; j++) {
            const pir_vec3 *v = &b->source->vertex[b->source->corner[b->item[i]][j]];
            double x = d[0] * v->x, y = d[1] * v->y, z = d[2] * v->z, at = x + y + z;
            double error = 0x1p-50 * (fabs(x) + fabs(y) + fabs(z));
            low = at - error < low ? at - error : low;
            high = at + error > high ? at + error : high;
        }
    node->slab_low[child] = pir_float_under(low);
    node->slab_high[child] = pir_float_over(high);
}

static uint32_t least_item(const struct builder *b, struct triangle_range range) {
    uint32_t least = UINT32_MAX;
    for (uint32_t i = range.begin; i < range.end; i++)
        least = b->item[i] < least ? b->item[i] : least;
    return least;
}

/* A node of these parts; inner children are filled in by tasks. */
static void fill_node(struct builder *b, pir_mesh_node *node, const struct triangle_range *parts, int count) {
    struct box box[PIR_MESH_WIDTH], all = nothing;
    for (int i = 0; i < count; i++) {
        box[i] = nothing;
        for (uint32_t j = parts[i].begin; j < parts[i].end; j++)
            join(&box[i], &b->box[j]);
        join(&all, &box[i]);
    }
    for (int k = 0; k < 3; k++)
        set_steps(node, k, all.low[k], all.high[k]);
    node->count = (uint8_t)count;
    for (int i = 0; i < PIR_MESH_WIDTH; i++) {
        if (i >= count) {
            set_no_child(node, i);
            continue;
        }
        uint32_t size = parts[i].end - parts[i].begin;
        set_child_box(node, i, &box[i]);
        set_slab(b, node, i, parts[i]);
        node->child[i] = size <= PIR_MESH_LEAF ? 1u << 31 | parts[i].begin << 2 | (size - 1) : PIR_MESH_NO_CHILD;
        node->least[i] = least_item(b, parts[i]);
    }
}

/* A new node's number, or PIR_MESH_NO_CHILD when out of memory. */
static uint32_t new_node(struct builder *b) {
    pir_mesh_tree *tree = b->tree;
    if (tree->node_count == b->node_room) {
        uint32_t room = 2 * b->node_room + 4;
        pir_mesh_node *node = PIR_RESIZE(b->allocator, tree->node, b->node_room, room);
        if (!node)
            return PIR_MESH_NO_CHILD;
        tree->node = node;
        b->node_room = room;
    }
    memset(&tree->node[tree->node_count], 0, sizeof *tree->node);
    return tree->node_count++;
}

static bool make_nodes(struct builder *b, uint32_t count) {
    struct node_task stack[PIR_MESH_WIDTH * PIR_MESH_DEPTH];
    uint32_t used = 0;
    stack[used++] = (struct node_task){{0, count}, 0, PIR_MESH_NO_CHILD, 0};
    while (used > 0) {
        struct node_task task = stack[--used];
        struct triangle_range parts[PIR_MESH_WIDTH];
        int part_count = divide(b, task.range, task.depth, parts);
        uint32_t n = new_node(b);
        if (n == PIR_MESH_NO_CHILD)
            return false;
        fill_node(b, &b->tree->node[n], parts, part_count);
        if (task.parent != PIR_MESH_NO_CHILD)
            b->tree->node[task.parent].child[task.slot] = n;
        for (int i = part_count; i-- > 0;)
            if (parts[i].end - parts[i].begin > PIR_MESH_LEAF)
                stack[used++] = (struct node_task){parts[i], task.depth + 1, n, (uint32_t)i};
    }
    return true;
}

bool pir_mesh_tree_make(pir_mesh_tree *tree, const pir_allocator *allocator, const pir_mesh_source *source,
                        uint32_t *item, uint32_t count) {
    *tree = (pir_mesh_tree){0};
    struct builder b = {allocator, source, tree, PIR_NEW(allocator, struct box, count), item, 0};
    if (!b.box)
        return false;
    struct box all = nothing;
    for (uint32_t i = 0; i < count; i++) {
        b.box[i] = box_of(source, item[i]);
        join(&all, &b.box[i]);
    }
    memcpy(tree->low, all.low, sizeof all.low);
    memcpy(tree->high, all.high, sizeof all.high);
    bool made = make_nodes(&b, count);
    PIR_FREE(allocator, b.box, count);
    pir_mesh_node *node = made ? PIR_RESIZE(allocator, tree->node, b.node_room, tree->node_count) : NULL;
    if (!node) {
        PIR_FREE(allocator, tree->node, b.node_room);
        *tree = (pir_mesh_tree){0};
        return false;
    }
    tree->node = node;
    tree->item = item;
    tree->item_count = count;
    return true;
}

void pir_mesh_tree_finish(pir_mesh_tree *tree, const pir_allocator *allocator) {
    PIR_FREE(allocator, tree->node, tree->node_count);
    PIR_FREE(allocator, tree->item, tree->item_count);
}

/* --- checks --- */

/* Whether child `i` of a node holds a triangle. */
static bool holds(const pir_mesh_node *node, int i, const pir_mesh_source *source, uint32_t triangle) {
    bool inside = triangle >= node->least[i];
    for (int c = 0; c < 3; c++) {
        const pir_vec3 *v = &source->vertex[source->corner[triangle][c]];
        const double x[3] = {v->x, v->y, v->z};
        long double along = 0;
        for (int k = 0; k < 3; k++) {
            along += (long double)node->normal[k][i] * (long double)x[k];
            inside = inside && x[k] >= (double)pir_mesh_bound(node, k, node->low[k][i]) &&
                     x[k] <= (double)pir_mesh_bound(node, k, node->high[k][i]);
        }
        inside = inside && along >= (long double)node->slab_low[i] && along <= (long double)node->slab_high[i];
    }
    return inside;
}

/* Whether child `i` of a node holds all below it, which are the items from *next on; *next is then after them. */
static bool child_is_valid(const pir_mesh_tree *tree, const pir_mesh_source *source, const pir_mesh_node *node, int i,
                           uint32_t *next) {
    uint32_t stack[PIR_MESH_WIDTH * PIR_MESH_DEPTH], used = 0, least = UINT32_MAX;
    stack[used++] = node->child[i];
    while (used > 0) {
        uint32_t child = stack[--used];
        if (!pir_mesh_is_leaf(child)) {
            const pir_mesh_node *below = &tree->node[child];
            if (child >= tree->node_count || used + below->count > PIR_MESH_WIDTH * PIR_MESH_DEPTH)
                return false;
            for (int j = below->count; j-- > 0;)
                stack[used++] = below->child[j];
            continue;
        }
        uint32_t end = *next + pir_mesh_leaf_count(child);
        if (pir_mesh_leaf_start(child) != *next || end > tree->item_count)
            return false;
        for (; *next < end; ++*next) {
            least = tree->item[*next] < least ? tree->item[*next] : least;
            if (!holds(node, i, source, tree->item[*next]))
                return false;
        }
    }
    return least == node->least[i];
}

/* The first item below a node. */
static uint32_t first_item(const pir_mesh_tree *tree, uint32_t n) {
    for (uint32_t depth = 0; depth <= PIR_MESH_DEPTH && n < tree->node_count; depth++) {
        uint32_t child = tree->node[n].child[0];
        if (pir_mesh_is_leaf(child))
            return pir_mesh_leaf_start(child);
        n = child;
    }
    return UINT32_MAX;
}

bool pir_mesh_tree_is_valid(const pir_mesh_tree *tree, const pir_mesh_source *source) {
    for (uint32_t n = 0; n < tree->node_count; n++) {
        uint32_t next = n == 0 ? 0 : first_item(tree, n);
        for (int i = 0; i < tree->node[n].count; i++)
            if (!child_is_valid(tree, source, &tree->node[n], i, &next))
                return false;
        if (n == 0 && next != tree->item_count)
            return false;
    }
    return tree->node_count > 0;
}
