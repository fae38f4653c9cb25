/* SPDX-License-Identifier: MIT */
#include "plan.h"

#include <stdint.h>
#include <string.h>

enum { TREE_ROOM = 20000 };

/* The longest motion that a tree grows by, as spot_distance has it. */
static const double stride = 0.4;

typedef struct grown {
    spot at[TREE_ROOM];
    int parent[TREE_ROOM], count;
} grown;

/* [0, 1), by splitmix64: the same path on every run. */
static double random_share(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

static int nearest(const grown *tree, const spot *to) {
    int best = 0;
    for (int i = 1; i < tree->count; i++)
        if (spot_distance(&tree->at[i], to) < spot_distance(&tree->at[best], to))
            best = i;
    return best;
}

/*
 * Grows from the nearest spot towards `to`: 1 where it is reached, 0 after one stride, −1 where the way is not free.
 */
static int grow(world *place, grown *tree, const spot *to) {
    int from = nearest(tree, to);
    double far = spot_distance(&tree->at[from], to);
    spot next = far > stride ? spot_between(&tree->at[from], to, stride / far) : *to;
    if (tree->count == TREE_ROOM || !place_may_go(place, &tree->at[from], &next))
        return -1;
    tree->parent[tree->count] = from;
    tree->at[tree->count++] = next;
    return far <= stride;
}

/* The way from a tree's root to its last spot, in front of what `path` has; the new number of spots. */
static int put_branch(const grown *tree, spot *path, int count, int backwards) {
    int length = 0;
    for (int i = tree->count - 1; i >= 0 && count + length < PATH_ROOM; i = tree->parent[i])
        path[count + length++] = tree->at[i];
    for (int i = 0; backwards && i < length / 2; i++) {
        spot swap = path[count + i];
        path[count + i] = path[count + length - 1 - i];
        path[count + length - 1 - i] = swap;
    }
    return count + length;
}

int plan(world *place, const spot *start, const spot *goal, spot path[PATH_ROOM]) {
    static grown trees[2];
    uint64_t state = 1;
    for (int i = 0; i < 2; i++) {
        trees[i].at[0] = i ? *goal : *start;
        trees[i].parent[0] = -1;
        trees[i].count = 1;
    }
    for (int turn = 0; trees[0].count + trees[1].count < TREE_ROOM && !place->error; turn = 1 - turn) {
        grown *a = &trees[turn], *b = &trees[1 - turn];
        const double u[4] = {random_share(&state), random_share(&state), random_share(&state), random_share(&state)};
        const spot sample = {spot_least.x + u[0] * (spot_most.x - spot_least.x),
                             spot_least.y + u[1] * (spot_most.y - spot_least.y),
                             spot_least.z + u[2] * (spot_most.z - spot_least.z),
                             spot_least.turn + u[3] * (spot_most.turn - spot_least.turn)};
        if (grow(place, a, &sample) < 0)
            continue;
        int reached = 0;
        while (reached == 0)
            reached = grow(place, b, &a->at[a->count - 1]);
        if (reached == 1) {
            int count = put_branch(&trees[0], path, 0, 1);
            return put_branch(&trees[1], path, count - 1, 0); // both end at one spot
        }
    }
    return 0;
}

int shorten(world *place, spot path[PATH_ROOM], int count, int tries) {
    uint64_t state = 2;
    for (int i = 0; i < tries && count > 2; i++) {
        int from = (int)(random_share(&state) * (count - 2)), to = from + 2;
        to += (int)(random_share(&state) * (count - to));
        if (!place_may_go(place, &path[from], &path[to]))
            continue;
        memmove(&path[from + 1], &path[to], (size_t)(count - to) * sizeof *path);
        count -= to - from - 1;
    }
    return count;
}
