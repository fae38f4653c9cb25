/* SPDX-License-Identifier: MIT */
/* Memory asked for ahead: see fetch.h. */
#include "pair/fetch.h"

#include "pair/pair.h"

/* Bytes of a line of the caches. Where lines are longer some are asked for twice. */
#define LINE 64

/* How far the way to a feature of a body has been followed: each step reads what the one before has asked for. */
enum step { AT_BODY, AT_EDGE, AT_HALF, AT_ENDS, AT_VERTEX, AT_RING, AT_FACET, AT_LOOP, AT_CORNERS, AT_END };

/* The longest way, from a body by an edge to the facets of a ring. */
#define STEPS 6

struct way {
    enum step step, first; /* the first after the body */
    const pir_kept_body *kept;
    uint32_t index;  /* of the edge, halfedge, vertex or facet */
    uint32_t target; /* of a halfedge */
};

static inline void touch(const void *at) {
    __builtin_prefetch(at);
}

static inline void touch_bytes(const void *at, size_t size) {
    for (size_t i = 0; i < size; i += LINE)
        touch((const char *)at + i);
    touch((const char *)at + size - 1);
}

static void touch_ring(const pir_polytope *p, uint32_t vertex) {
    uint32_t start = p->ring_start[vertex], end = p->ring_start[vertex + 1];
    touch_bytes(&p->direction[start], (end - start) * sizeof *p->direction);
    touch(&p->left[start]);
    touch(&p->target[start]);
}

/* The next step. Returns where the way is then. */
static inline enum step take_step(struct way *way) {
    const pir_body *body = &way->kept->body;
    const pir_polytope *p = body->polytope;
    uint32_t i = way->index;
    switch (way->step) {
    case AT_BODY:
        touch_bytes(p, offsetof(pir_polytope, exact_vertex));
        return way->first;
    case AT_EDGE:
        way->index = p->edge_half[i];
        touch(&p->origin[way->index]);
        touch(&p->target[way->index]);
        return AT_HALF;
    case AT_HALF:
        touch(&p->direction[i]);
        way->index = p->origin[i];
        way->target = p->target[i];
        touch(&p->ring_start[way->target]);
        touch(&p->ring_start[way->index]);
        return AT_ENDS;
    case AT_ENDS:
        touch(&body->vertex[way->target]);
        touch(&body->vertex[i]);
        touch_ring(p, way->target);
        touch_ring(p, i);
        return AT_END;
    case AT_VERTEX:
        touch(&body->vertex[i]);
        touch_ring(p, i);
        return AT_RING;
    case AT_RING:
        for (uint32_t h = p->ring_start[i]; h < p->ring_start[i + 1]; h++)
            touch(&p->normal[p->left[h]]);
        return AT_END;
    case AT_FACET:
        touch(&p->normal[i]);
        touch(&body->offset[i]);
        touch(&p->loop[p->loop_start[i]]);
        return AT_LOOP;
    case AT_LOOP:
        for (uint32_t k = p->loop_start[i]; k < p->loop_start[i + 1]; k++) {
            touch(&p->direction[p->loop[k]]);
            touch(&p->origin[p->loop[k]]);
        }
        return AT_CORNERS;
    case AT_CORNERS:
        for (uint32_t k = p->loop_start[i]; k < p->loop_start[i + 1]; k++)
            touch(&body->vertex[p->origin[p->loop[k]]]);
        return AT_END;
    default:
        return AT_END;
    }
}

/* Where the ways to the features begin that the last answer of a pair rests on. */
static void begin_ways(const pir_pair *pair, struct way way[2]) {
    const pir_piece piece = pair->hint.facet;
    enum step p = piece.kind == PIR_FACET_FV ? AT_FACET : piece.kind == PIR_FACET_VF ? AT_VERTEX : AT_EDGE;
    enum step q = piece.kind == PIR_FACET_FV ? AT_VERTEX : piece.kind == PIR_FACET_VF ? AT_FACET : AT_HALF;
    way[0] = (struct way){AT_BODY, pair->hint.has_facet ? p : AT_END, pair->body_p, piece.first, 0};
    way[1] = (struct way){AT_BODY, pair->hint.has_facet ? q : AT_END, pair->body_q, piece.second, 0};
    touch_bytes(pair->body_p, sizeof *pair->body_p);
    touch_bytes(pair->body_q, sizeof *pair->body_q);
    if (pair->hint.deep && pair->surface)
        touch_bytes(pair->surface, offsetof(pir_surface, corner[1]));
}

void pir_pair_fetch(pir_pair *const *pairs, uint32_t count) {
    struct way way[2 * PIR_FETCH_MOST];
    for (uint32_t i = 0; i < count; i++)
        touch_bytes(pairs[i], sizeof *pairs[i]);
    for (uint32_t i = 0; i < count; i++)
        begin_ways(pairs[i], &way[2 * i]);
    for (int step = 0; step < STEPS; step++)
        for (uint32_t i = 0; i < 2 * count; i++)
            way[i].step = take_step(&way[i]);
}
