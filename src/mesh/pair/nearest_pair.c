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

/* Notes in entries the directions of the first lanes, and what these prove: that items are apart by a bound along n. */
static void note(const pir_trimesh_pair *pair, pir_front_entry *const *entries, int count, const pir_node_lanes *p,
                 const pir_node_axes *axes) {
    const pir_float_frame *f = &pair->floats;
    const float made = (float)pair->front.turn;
    pir_node_float4 taken = -axes->bound, radius = pir_lanes_root(pir_lanes_size(p)) * (1 + 0x1p-20f);
    for (int k = 0; k < 3; k++)
        taken +=
            axes->n[k] * (f->r[k][0] * p->middle[0] + f->r[k][1] * p->middle[1] + f->r[k][2] * p->middle[2] + f->t[k]);
    for (int i = 0; i < count; i++) {
        pir_front_entry *entry = entries[i];
        for (int k = 0; k < 3; k++) {
            entry->n[k] = axes->n[k][i];
            entry->middle[k] = p->middle[k][i];
        }
        entry->radius = radius[i];
        entry->taken = taken[i];
        entry->made = made;
    }
}

static bool keep(pir_trimesh_pair *pair, const pir_front_entry *entry, float reach, float bound) {
    return pir_mesh_front_add(&pair->front, &pair->allocator, entry, reach, bound);
}

/* Looks at the triangles of two leaves; the lower bound that they leave, and in the entry its direction. */
static float look_at_triangles(pir_trimesh_pair *pair, pir_front_entry *entry, const pir_node_lanes *p) {
    const uint32_t leaf[2] = {child_of(pair, 0, entry->p), child_of(pair, 1, entry->q)};
    pir_vec3 n = {(double)entry->n[0], (double)entry->n[1], (double)entry->n[2]};
    double gap, low = pir_leaf_pair_consider(&pair->best, &pair->frame, leaf, &n, &gap, &pair->counts);
    double length = sqrt(pir_vec_dot(n, n));
    pir_node_axes axes = {.bound = {pir_float_under(gap)}};
    const double along[3] = {n.x, n.y, n.z};
    for (int k = 0; k < 3; k++)
        axes.n[k][0] = length > 0 ? (float)(along[k] / length) : entry->n[k];
    note(pair, &entry, 1, p, &axes);
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
    uint32_t node = pir_item_child(mesh, item);
    for (int i = 0; i < PIR_NODE_LANES; i++)
        ret_items[i] = divide ? node * PIR_MESH_WIDTH + (uint32_t)i : item;
    if (divide)
        pir_node_lanes_set_node(ret_lanes, mesh, node);
    else
        pir_node_lanes_set_one(ret_lanes, mesh, item);
    return divide ? mesh->tree.node[node].count : 1;
}

/* Which of two items is divided: the larger one, unless it is a leaf. */
static int divided_side(const pir_trimesh_pair *pair, const pir_front_entry *entry) {
    if (pir_mesh_is_leaf(child_of(pair, 0, entry->p)))
        return 1;
    if (pir_mesh_is_leaf(child_of(pair, 1, entry->q)))
        return 0;
    return pir_item_size(pair->mesh[0], entry->p) >= pir_item_size(pair->mesh[1], entry->q) ? 0 : 1;
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
    const pir_node_float4 reach = pir_lanes_reach(&pair->floats, p);
    uint32_t first = tasks->used;
    struct nearest_task task[PIR_NODE_LANES];
    pir_front_entry *noted[PIR_NODE_LANES];
    for (int i = 0; i < PIR_NODE_LANES; i++) {
        task[i] = (struct nearest_task){entries[i], axes.bound[i]};
        noted[i] = &task[i].entry;
    }
    note(pair, noted, count, p, &axes);
    for (int i = 0; i < count; i++)
        if (!is_far(pair, (double)task[i].bound))
            push(tasks, first, &task[i]);
        else if (!keep(pair, &task[i].entry, reach[i], task[i].bound))
            return false;
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
            pir_node_lanes_set_one(&p, pair->mesh[0], task.entry.p);
            // items that are settled are as far apart as the best
            float bound = is_far(pair, (double)task.bound) ? task.bound
                          : is_over                        ? pir_float_under(pair->best.span.low)
                                                           : look_at_triangles(pair, &task.entry, &p);
            done = keep(pair, &task.entry, pir_lanes_reach(&pair->floats, &p)[0], bound) && break_ties(pair);
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
    pir_node_lanes p, q;
    pir_node_lanes_set_node(&p, pair->mesh[0], 0);
    int of_p = pair->mesh[0]->tree.node[0].count, of_q = pair->mesh[1]->tree.node[0].count;
    for (int j = 0; j < of_q; j++) {
        pir_front_entry entries[PIR_NODE_LANES];
        for (int i = 0; i < PIR_NODE_LANES; i++)
            entries[i] = (pir_front_entry){.p = (uint32_t)i, .q = (uint32_t)j, .n = {1, 0, 0}};
        pir_node_lanes_set_one(&q, pair->mesh[1], (uint32_t)j);
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
    pir_mesh_item items[2][PIR_NODE_LANES];
    pir_front_entry *entries[PIR_NODE_LANES];
    for (int i = 0; i < PIR_NODE_LANES; i++) {
        entries[i] = &pair->front.entry[which[i < count ? i : 0]];
        items[0][i] = entries[i]->p;
        items[1][i] = entries[i]->q;
        for (int k = 0; k < 3; k++)
            axes.n[k][i] = entries[i]->n[k];
    }
    pir_node_lanes_set(&p, pair->mesh[0], items[0]);
    pir_node_lanes_set(&q, pair->mesh[1], items[1]);
    pir_bound_along(&pair->floats, &p, &q, &axes);
    pair->counts.bounds += (uint64_t)count;
    // of leaves the triangles tell more than other directions
    bool more = false;
    for (int i = 0; i < count; i++)
        more = more || (!is_far(pair, (double)axes.bound[i]) && !are_leaves(pair, entries[i]));
    if (more)
        pir_bound_by_nodes(&pair->floats, &p, &q, &axes);
    note(pair, entries, count, &p, &axes);
    unsigned short_of = 0;
    for (int i = 0; i < count; i++)
        if (is_far(pair, (double)axes.bound[i]))
            pir_mesh_front_renew(&pair->front, which[i], axes.bound[i]);
        else
            short_of |= 1u << i;
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
        pir_node_lanes_set_one(&p, pair->mesh[0], entry.p);
        float bound = look_at_triangles(pair, &pair->front.entry[i], &p);
        pir_mesh_front_renew(&pair->front, i, bound);
        return break_ties(pair);
    }
    struct nearest_tasks tasks;
    tasks.used = 0;
    pir_mesh_front_drop(&pair->front, i);
    return divide(pair, &tasks, &entry) && work(pair, &tasks);
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
    const float most = best->p != PIR_TRIANGLE_NONE ? pir_float_under(best->span.high) : HUGE_VALF;
    expired = pir_mesh_front_renew_along(front, &pair->floats, expired, most);
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
