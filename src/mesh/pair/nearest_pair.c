/* SPDX-License-Identifier: MIT */
/*
 * The nearest two triangles. Those of the last call bound the distance from above; entries of the front that are
 * certainly farther, after the motion since, are not looked at. Of the others the direction that proved them is tried
 * again, then more directions, then triangles, or the children of the larger node take the entry's place.
 *
 * The front only grows, until it has twice as many entries as when it was made: then it is made from the roots
 * again, as it is where most of it has expired.
 */
#include "mesh/pair/nearest_pair.h"

#include "mesh/pair/pair_descent.h"

/* Entries below this many are looked at rather than made anew, and by how much the front may grow beyond twice. */
#define FEW 512

/* Pairs of items to be looked at: three more for each of at most 2 · PIR_MESH_DEPTH levels. */
#define STACK (3 * 2 * PIR_MESH_DEPTH + PIR_NODE_LANES * PIR_NODE_LANES)

struct nearest_task {
    pir_front_entry entry;
    float bound;
};

struct nearest_tasks {
    struct nearest_task task[STACK];
    uint32_t used;
};

/* Pairs of leaves looked at, after which sides are found out: more than a front that is made anew takes. */
#define MANY_LOOKS 4096

/* Whether the best two are nearest at these two vertices, certainly. */
static bool is_of_vertices(const pir_best_pair *best, const uint32_t vertex[2]) {
    const pir_span *span = &best->span;
    return span->certain && span->a.id[1] == UINT32_MAX && span->b.id[1] == UINT32_MAX && span->a.id[0] == vertex[0] &&
           span->b.id[0] == vertex[1];
}

static bool is_far(const pir_trimesh_pair *pair, double bound) {
    return pair->best.p != PIR_TRIANGLE_NONE && bound > pair->best.span.high;
}

/*
 * Whether no pair below two items can take the place of the best, though they are no farther: of those behind the
 * vertices that are the nearest none is nearer, and none has lower numbers.
 */
static bool is_settled(const pir_trimesh_pair *pair, const pir_front_entry *entry) {
    const pir_tie_sides *sides = &pair->sides;
    const pir_best_pair *best = &pair->best;
    if (!sides->made || !sides->is_behind[0][entry->p] || !sides->is_behind[1][entry->q] || best->meets ||
        !is_of_vertices(best, sides->vertex))
        return false;
    uint32_t least = pir_item_least(pair->mesh[0], entry->p);
    return least > best->p || (least == best->p && pir_item_least(pair->mesh[1], entry->q) >= best->q);
}

static uint32_t child_of(const pir_trimesh_pair *pair, int side, pir_mesh_item item) {
    return pir_item_child(pair->mesh[side], item);
}

static bool are_leaves(const pir_trimesh_pair *pair, const pir_front_entry *entry) {
    return pir_mesh_is_leaf(child_of(pair, 0, entry->p)) && pir_mesh_is_leaf(child_of(pair, 1, entry->q));
}

/* --- leaves --- */

/* Notes what the direction of an entry proves: that its items are apart by `gap` along it. */
static void note(const pir_trimesh_pair *pair, pir_front_entry *entry, const pir_node_lanes *p, int lane, float gap) {
    const pir_float_frame *f = &pair->floats;
    entry->taken = -gap;
    entry->radius = sqrtf(pir_lane_size(p, lane)) * (1 + 0x1p-20f);
    entry->made = (float)pair->front.turn;
    for (int k = 0; k < 3; k++)
        entry->middle[k] = p->middle[k][lane];
    for (int k = 0; k < 3; k++)
        entry->taken += entry->n[k] * (f->r[k][0] * entry->middle[0] + f->r[k][1] * entry->middle[1] +
                                       f->r[k][2] * entry->middle[2] + f->t[k]);
}

static bool keep(pir_trimesh_pair *pair, const pir_front_entry *entry, const pir_node_lanes *p, int lane, float bound) {
    return pir_mesh_front_add(&pair->front, &pair->allocator, entry, pir_lane_reach(&pair->floats, p, lane), bound);
}

/* Looks at the triangles of two leaves; the lower bound that they leave, and in the entry its direction. */
static float look_at_triangles(pir_trimesh_pair *pair, pir_front_entry *entry, const pir_node_lanes *p) {
    const uint32_t leaf[2] = {child_of(pair, 0, entry->p), child_of(pair, 1, entry->q)};
    pir_vec3 n = {(double)entry->n[0], (double)entry->n[1], (double)entry->n[2]};
    double gap, low = pir_leaf_pair_consider(&pair->best, &pair->frame, leaf, &n, &gap, &pair->counts);
    double length = sqrt(pir_vec_dot(n, n));
    if (length > 0) {
        entry->n[0] = (float)(n.x / length);
        entry->n[1] = (float)(n.y / length);
        entry->n[2] = (float)(n.z / length);
    }
    note(pair, entry, p, 0, pir_float_under(gap));
    pair->looks++;
    return pir_float_under(low < 0x1p62 ? low : 0x1p62);
}

/*
 * Where very many pairs of leaves were looked at that are about as near as the best: takes the lowest of them, and
 * finds out which items lie behind. False when out of memory.
 */
static bool break_ties(pir_trimesh_pair *pair) {
    pir_best_pair *best = &pair->best;
    if (pair->looks < MANY_LOOKS || best->meets)
        return true;
    pair->looks = 0;
    const uint32_t vertex[2] = {best->span.a.id[0], best->span.b.id[0]};
    if (!is_of_vertices(best, vertex) || (pair->sides.made && is_of_vertices(best, pair->sides.vertex)))
        return true;
    pir_lowest_pair_find(pair, best->span.high);
    return best->meets || !is_of_vertices(best, vertex) ||
           pir_tie_sides_make(&pair->sides, &pair->frame, &pair->allocator, vertex);
}

/* --- descent --- */

/* The children of an item, or the item itself by lanes that are all like it. */
static int set_lanes(const pir_trimesh_pair *pair, int side, pir_mesh_item item, bool divide,
                     pir_mesh_item ret_items[PIR_NODE_LANES], pir_node_lanes *ret_lanes) {
    const pir_trimesh *mesh = pair->mesh[side];
    if (!divide) {
        pir_node_lanes one;
        pir_lane_set(&one, 0, mesh, item);
        pir_node_lanes_repeat(ret_lanes, &one, 0);
        for (int i = 0; i < PIR_NODE_LANES; i++)
            ret_items[i] = item;
        return 1;
    }
    uint32_t node = pir_item_child(mesh, item);
    pir_node_lanes_set_node(ret_lanes, mesh, node);
    for (int i = 0; i < PIR_NODE_LANES; i++)
        ret_items[i] = node * PIR_MESH_WIDTH + (uint32_t)i;
    return mesh->tree.node[node].count;
}

/* Which of two items is divided: the larger one, unless it is a leaf. */
static int divided_side(const pir_trimesh_pair *pair, const pir_front_entry *entry) {
    pir_node_lanes p, q;
    if (pir_mesh_is_leaf(child_of(pair, 0, entry->p)))
        return 1;
    if (pir_mesh_is_leaf(child_of(pair, 1, entry->q)))
        return 0;
    pir_lane_set(&p, 0, pair->mesh[0], entry->p);
    pir_lane_set(&q, 0, pair->mesh[1], entry->q);
    return pir_lane_size(&p, 0) >= pir_lane_size(&q, 0) ? 0 : 1;
}

/* Puts a task where it belongs among those from `first` on: what is nearest is looked at first. */
static void push(struct nearest_tasks *tasks, uint32_t first, const struct nearest_task *task) {
    uint32_t at = tasks->used++;
    for (; at > first && tasks->task[at - 1].bound < task->bound; at--)
        tasks->task[at] = tasks->task[at - 1];
    tasks->task[at] = *task;
}

/* Bounds lanes of pairs; what is far is kept, the others become tasks. False when out of memory. */
static bool sort_lanes(pir_trimesh_pair *pair, struct nearest_tasks *tasks, const pir_node_lanes *p,
                       const pir_node_lanes *q, const pir_front_entry *entries, int count) {
    pir_node_axes axes;
    bool all_far = true;
    for (int i = 0; i < PIR_NODE_LANES; i++)
        for (int k = 0; k < 3; k++)
            axes.n[k][i] = entries[i < count ? i : 0].n[k];
    pir_bound_along(&pair->floats, p, q, &axes);
    pair->counts.bounds += (uint64_t)count;
    for (int i = 0; i < count; i++)
        all_far = all_far && is_far(pair, (double)axes.bound[i]);
    if (!all_far)
        pir_bound_by_nodes(&pair->floats, p, q, &axes);
    uint32_t first = tasks->used;
    for (int i = 0; i < count; i++) {
        struct nearest_task task = {.entry = entries[i], .bound = axes.bound[i]};
        for (int k = 0; k < 3; k++)
            task.entry.n[k] = axes.n[k][i];
        note(pair, &task.entry, p, i, task.bound);
        if (!is_far(pair, (double)task.bound))
            push(tasks, first, &task);
        else if (!keep(pair, &task.entry, p, i, task.bound))
            return false;
    }
    return true;
}

/* Divides a pair of items that is not far. */
static bool divide(pir_trimesh_pair *pair, struct nearest_tasks *tasks, const pir_front_entry *entry) {
    pir_node_lanes lanes[2];
    pir_mesh_item items[2][PIR_NODE_LANES];
    pir_front_entry entries[PIR_NODE_LANES];
    int side = divided_side(pair, entry), count = 1;
    for (int s = 0; s < 2; s++) {
        int n = set_lanes(pair, s, s == 0 ? entry->p : entry->q, s == side, items[s], &lanes[s]);
        count = n > count ? n : count;
    }
    for (int i = 0; i < PIR_NODE_LANES; i++)
        entries[i] =
            (pir_front_entry){.p = items[0][i], .q = items[1][i], .n = {entry->n[0], entry->n[1], entry->n[2]}};
    return sort_lanes(pair, tasks, &lanes[0], &lanes[1], entries, count);
}

/* Works off tasks. What they come to stands in the front afterwards. */
static bool work(pir_trimesh_pair *pair, struct nearest_tasks *tasks) {
    while (tasks->used > 0 && !pair->best.meets) {
        struct nearest_task task = tasks->task[--tasks->used];
        bool done = true;
        bool is_over = is_far(pair, (double)task.bound) || is_settled(pair, &task.entry);
        if (is_over || are_leaves(pair, &task.entry)) {
            pir_node_lanes p;
            pir_lane_set(&p, 0, pair->mesh[0], task.entry.p);
            // items that are settled are as far apart as the best
            float bound = is_far(pair, (double)task.bound) ? task.bound
                          : is_over                        ? pir_float_under(pair->best.span.low)
                                                           : look_at_triangles(pair, &task.entry, &p);
            done = keep(pair, &task.entry, &p, 0, bound) && break_ties(pair);
        } else {
            done = divide(pair, tasks, &task.entry);
        }
        if (!done)
            return false;
    }
    return true;
}

/* --- from the roots --- */

static bool rebuild_once(pir_trimesh_pair *pair) {
    struct nearest_tasks tasks;
    tasks.used = 0; // the rest is written before it is read
    pair->front.count = 0;
    pir_node_lanes p, q, one;
    pir_node_lanes_set_node(&p, pair->mesh[0], 0);
    pir_node_lanes_set_node(&one, pair->mesh[1], 0);
    int of_p = pair->mesh[0]->tree.node[0].count, of_q = pair->mesh[1]->tree.node[0].count;
    for (int j = 0; j < of_q; j++) {
        pir_front_entry entries[PIR_NODE_LANES];
        for (int i = 0; i < PIR_NODE_LANES; i++)
            entries[i] = (pir_front_entry){.p = (uint32_t)i, .q = (uint32_t)j, .n = {1, 0, 0}};
        pir_node_lanes_repeat(&q, &one, j);
        if (!sort_lanes(pair, &tasks, &p, &q, entries, of_p))
            return false;
    }
    return work(pair, &tasks);
}

/* Makes the front anew; without a best pair to begin with, twice: the first time finds one. */
static bool rebuild(pir_trimesh_pair *pair) {
    bool had_best = pair->best.p != PIR_TRIANGLE_NONE;
    pair->counts.rebuilt++;
    if (!rebuild_once(pair) || (!had_best && !pair->best.meets && !rebuild_once(pair)))
        return false;
    pair->front.built = pair->front.count;
    return true;
}

/* --- what has expired --- */

/* Up to four entries along the directions that proved them, then others: bit i where no bound is enough. */
static unsigned try_again(pir_trimesh_pair *pair, const uint32_t *which, int count) {
    pir_node_lanes p, q;
    pir_node_axes axes;
    for (int i = 0; i < PIR_NODE_LANES; i++) {
        const pir_front_entry *entry = &pair->front.entry[which[i < count ? i : 0]];
        pir_lane_set(&p, i, pair->mesh[0], entry->p);
        pir_lane_set(&q, i, pair->mesh[1], entry->q);
        for (int k = 0; k < 3; k++)
            axes.n[k][i] = entry->n[k];
    }
    pir_bound_along(&pair->floats, &p, &q, &axes);
    pair->counts.bounds += (uint64_t)count;
    // of leaves the triangles tell more than other directions
    bool more = false;
    for (int i = 0; i < count; i++)
        more = more || (!is_far(pair, (double)axes.bound[i]) && !are_leaves(pair, &pair->front.entry[which[i]]));
    if (more)
        pir_bound_by_nodes(&pair->floats, &p, &q, &axes);
    unsigned short_of = 0;
    for (int i = 0; i < count; i++) {
        pir_front_entry *entry = &pair->front.entry[which[i]];
        for (int k = 0; k < 3; k++)
            entry->n[k] = axes.n[k][i];
        note(pair, entry, &p, i, axes.bound[i]);
        if (is_far(pair, (double)axes.bound[i]))
            pir_mesh_front_renew(&pair->front, which[i], axes.bound[i]);
        else
            short_of |= 1u << i;
    }
    return short_of;
}

/* An entry that no direction is enough for any more: its triangles, or its children in its place. */
static bool look_again(pir_trimesh_pair *pair, uint32_t i) {
    pir_front_entry entry = pair->front.entry[i];
    if (is_settled(pair, &entry)) {
        pir_mesh_front_renew(&pair->front, i, pir_float_under(pair->best.span.low));
        return true;
    }
    if (are_leaves(pair, &entry)) {
        pir_node_lanes p;
        pir_lane_set(&p, 0, pair->mesh[0], entry.p);
        float bound = look_at_triangles(pair, &pair->front.entry[i], &p);
        pir_mesh_front_renew(&pair->front, i, bound);
        return break_ties(pair);
    }
    struct nearest_tasks tasks;
    tasks.used = 0;
    pir_mesh_front_drop(&pair->front, i);
    return divide(pair, &tasks, &entry) && work(pair, &tasks);
}

/* Renews entries that their directions still prove, and leaves the others in the list; how many these are. */
static uint32_t renew_along(pir_trimesh_pair *pair, uint32_t count) {
    uint32_t *which = pair->front.expired, left = 0;
    for (uint32_t i = 0; i < count; i++) {
        float bound = pir_mesh_front_along(&pair->front, &pair->floats, which[i]);
        if (is_far(pair, (double)bound))
            pir_mesh_front_renew(&pair->front, which[i], bound);
        else
            which[left++] = which[i];
    }
    return left;
}

static bool look_at_expired(pir_trimesh_pair *pair, uint32_t count) {
    const uint32_t *which = pair->front.expired;
    // they are listed from the last to the first, so that what takes the place of one that is dropped was looked at
    for (uint32_t at = 0; at < count; at += PIR_NODE_LANES) {
        uint32_t lanes[PIR_NODE_LANES];
        int left = count - at < PIR_NODE_LANES ? (int)(count - at) : PIR_NODE_LANES;
        for (int i = 0; i < left; i++)
            lanes[i] = which[at + (uint32_t)i];
        unsigned short_of = try_again(pair, lanes, left);
        for (int i = 0; i < left && !pair->best.meets; i++) {
            if (short_of >> i & 1 && !look_again(pair, lanes[i]))
                return false;
            which = pair->front.expired;
        }
    }
    return true;
}

/* --- a call --- */

static bool update(pir_trimesh_pair *pair) {
    pir_best_pair *best = &pair->best;
    pir_mesh_front *front = &pair->front;
    pair->sides.made = false;
    pair->looks = 0;
    if (best->p != PIR_TRIANGLE_NONE)
        pir_best_pair_begin(best, &pair->frame, best->p, best->q, &pair->counts);
    if (best->meets)
        return true;
    if (front->count == 0 || front->count > 2 * front->built + FEW)
        return rebuild(pair);
    uint32_t expired = pir_mesh_front_expired(front, best->span.high);
    pair->counts.expired += expired;
    expired = renew_along(pair, expired);
    if (expired > FEW && expired > front->count / 2)
        return rebuild(pair);
    return look_at_expired(pair, expired);
}

pir_status pir_nearest_pair_update(pir_trimesh_pair *pair) {
    pir_mesh_front_move(&pair->front, &pair->frame, pair->about);
    bool done = update(pair);
    if (!done)
        pir_best_pair_clear(&pair->best);
    if (!done || pair->best.meets)
        pair->front.count = 0;
    return done ? PIR_OK : PIR_ERR_MEMORY;
}
