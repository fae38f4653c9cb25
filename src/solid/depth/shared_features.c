/* SPDX-License-Identifier: MIT */
/* See shared_features.h. Doubles pass over most pairs; those that are near are compared in integers. */
#include "solid/depth/shared_features.h"

#include <gmp.h>

#include "base/vec.h"
#include "polytope/polytope.h"

/* Scratch in integers: two points of four, a normal of three, and what is made of them. */
struct exact_scratch {
    mpz_t x[4], y[4], n[3], m[3], s, t;
};

static void scratch_init(struct exact_scratch *e) {
    mpz_inits(e->x[0], e->x[1], e->x[2], e->x[3], e->y[0], e->y[1], e->y[2], e->y[3], NULL);
    mpz_inits(e->n[0], e->n[1], e->n[2], e->m[0], e->m[1], e->m[2], e->s, e->t, NULL);
}

static void scratch_clear(struct exact_scratch *e) {
    mpz_clears(e->x[0], e->x[1], e->x[2], e->x[3], e->y[0], e->y[1], e->y[2], e->y[3], NULL);
    mpz_clears(e->n[0], e->n[1], e->n[2], e->m[0], e->m[1], e->m[2], e->s, e->t, NULL);
}

static void set_int(mpz_ptr to, const pir_int *a) {
    mpz_t view;
    mpz_set(to, mpz_roinit_n(view, a->limb, a->size));
}

/* Vertex v of a piece as X, Y, Z over W. */
static void set_vertex(const pir_polytope *piece, uint32_t v, mpz_t *x) {
    const pir_int3 at = pir_vectors_at(&piece->exact_vertex, v);
    mpz_t view;
    for (int k = 0; k < 3; k++) {
        set_int(x[k], &at.c[k]);
        mpz_mul(x[k], x[k], mpz_roinit_n(view, piece->scale.num.limb, piece->scale.num.size));
    }
    set_int(x[3], &piece->scale.den);
}

static void set_normal(const pir_polytope *piece, uint32_t face, mpz_t *n) {
    const pir_int3 normal = pir_vectors_at(&piece->exact_normal, face);
    for (int k = 0; k < 3; k++)
        set_int(n[k], &normal.c[k]);
}

static bool are_equal(struct exact_scratch *e) {
    bool equal = true;
    for (int k = 0; k < 3 && equal; k++) {
        mpz_mul(e->s, e->x[k], e->y[3]);
        mpz_mul(e->t, e->y[k], e->x[3]);
        equal = mpz_cmp(e->s, e->t) == 0;
    }
    return equal;
}

/* Whether x and y are equally high along n. */
static bool are_level(struct exact_scratch *e) {
    mpz_set_ui(e->s, 0);
    mpz_set_ui(e->t, 0);
    for (int k = 0; k < 3; k++) {
        mpz_addmul(e->s, e->n[k], e->x[k]);
        mpz_addmul(e->t, e->n[k], e->y[k]);
    }
    mpz_mul(e->s, e->s, e->y[3]);
    mpz_mul(e->t, e->t, e->x[3]);
    return mpz_cmp(e->s, e->t) == 0;
}

static bool are_parallel(struct exact_scratch *e) {
    bool parallel = true;
    for (int k = 0; k < 3 && parallel; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(e->s, e->n[i], e->m[j]);
        mpz_submul(e->s, e->n[j], e->m[i]);
        parallel = mpz_sgn(e->s) == 0;
    }
    return parallel;
}

/* The piece that a vertex or a face is of, by where those of each piece begin. */
static uint32_t piece_of(const uint32_t *start, uint32_t number) {
    uint32_t i = 0;
    while (start[i + 1] <= number)
        i++;
    return i;
}

/* --- vertices and planes --- */

static void number_vertices(pir_shared_features *s, const pir_compound *c, uint32_t *first, struct exact_scratch *e) {
    for (uint32_t v = 0; v < c->vertex_start[c->count]; v++) {
        const double *x = c->vertex[v];
        uint32_t id = 0;
        for (; id < s->vertices; id++) {
            const uint32_t other = first[id];
            const double *y = c->vertex[other];
            // equal numbers have equal nearest doubles
            if (x[0] != y[0] || x[1] != y[1] || x[2] != y[2])
                continue;
            const uint32_t i = piece_of(c->vertex_start, v), j = piece_of(c->vertex_start, other);
            set_vertex(c->piece[i], v - c->vertex_start[i], e->x);
            set_vertex(c->piece[j], other - c->vertex_start[j], e->y);
            if (are_equal(e))
                break;
        }
        if (id == s->vertices)
            first[s->vertices++] = v;
        s->vertex[v] = id;
    }
}

/* A vertex of a face of piece i, and its normal. */
static void set_face(const pir_compound *c, uint32_t f, mpz_t *x, mpz_t *n) {
    const uint32_t i = piece_of(c->face_start, f), face = f - c->face_start[i];
    const pir_polytope *piece = c->piece[i];
    set_vertex(piece, piece->origin[piece->loop[piece->loop_start[face]]], x);
    set_normal(piece, face, n);
}

static void number_planes(pir_shared_features *s, const pir_compound *c, uint32_t *first, struct exact_scratch *e) {
    for (uint32_t f = 0; f < c->face_start[c->count]; f++) {
        const pir_compound_face *own = &c->face[f];
        uint32_t id = 0;
        for (; id < s->planes; id++) {
            const pir_compound_face *other = &c->face[first[id]];
            const double *n = own->normal, *m = other->normal, cosine = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
            if (fabs(cosine) < 0.999 ||
                fabs(own->offset - copysign(other->offset, cosine * other->offset)) > 0x1p-30 * c->reach)
                continue;
            set_face(c, f, e->x, e->n);
            set_face(c, first[id], e->y, e->m);
            if (are_parallel(e) && are_level(e))
                break;
        }
        if (id == s->planes)
            first[s->planes++] = f;
        s->plane[f] = id;
    }
}

static void find_incidences(pir_shared_features *s, const pir_compound *c, const uint32_t *first_vertex,
                            const uint32_t *first_plane, struct exact_scratch *e) {
    for (uint32_t p = 0; p < s->planes; p++) {
        const pir_compound_face *face = &c->face[first_plane[p]];
        set_face(c, first_plane[p], e->y, e->n);
        for (uint32_t v = 0; v < s->vertices; v++) {
            const double *x = c->vertex[first_vertex[v]], *n = face->normal;
            if (fabs(n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - face->offset) > 0x1p-40 * c->reach)
                continue;
            const uint32_t i = piece_of(c->vertex_start, first_vertex[v]);
            set_vertex(c->piece[i], first_vertex[v] - c->vertex_start[i], e->x);
            if (are_level(e))
                s->on[(size_t)p * s->words + v / 64] |= (uint64_t)1 << v % 64;
        }
    }
}

/* Whether a piece's face holds a vertex of the body that is in its plane, as far as doubles and planes tell. */
static bool holds(const pir_shared_features *s, const pir_compound *c, uint32_t face, uint32_t vertex) {
    const uint32_t i = piece_of(c->face_start, face);
    const double *x = c->vertex[vertex];
    for (uint32_t g = c->face_start[i]; g < c->face_start[i + 1]; g++) {
        const double *n = c->face[g].normal, over = n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - c->face[g].offset;
        if (over > -0x1p-40 * c->reach && !pir_shared_features_on(s, s->plane[g], s->vertex[vertex]))
            return false;
    }
    return true;
}

/* Whether one face of another piece covers all of a face from the other side. */
static bool is_inner_face(const pir_shared_features *s, const pir_compound *c, uint32_t f) {
    const uint32_t i = piece_of(c->face_start, f), face = f - c->face_start[i];
    const pir_polytope *piece = c->piece[i];
    const double *n = c->face[f].normal;
    for (uint32_t g = 0; g < c->face_start[c->count]; g++) {
        const double *m = c->face[g].normal;
        if (s->plane[g] != s->plane[f] || n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0)
            continue;
        bool covered = true;
        for (uint32_t k = piece->loop_start[face]; k < piece->loop_start[face + 1] && covered; k++)
            covered = holds(s, c, g, c->vertex_start[i] + piece->origin[piece->loop[k]]);
        if (covered)
            return true;
    }
    return false;
}

static void find_inner(pir_shared_features *s, const pir_compound *c) {
    for (uint32_t f = 0; f < c->face_start[c->count]; f++) {
        s->inner_face[f] = is_inner_face(s, c, f);
        s->outer_plane[s->plane[f]] = s->outer_plane[s->plane[f]] || !s->inner_face[f];
    }
    for (uint32_t v = 0; v < s->vertices; v++)
        s->inner_vertex[v] = pir_shared_features_inner_edge(s, v, v);
}

bool pir_shared_features_inner_edge(const pir_shared_features *shared, uint32_t a, uint32_t b) {
    for (uint32_t p = 0; p < shared->planes; p++)
        if (shared->outer_plane[p] && pir_shared_features_on(shared, p, a) && pir_shared_features_on(shared, p, b))
            return false;
    return true;
}

bool pir_shared_features_init(pir_shared_features *shared, const pir_compound *compound,
                              const pir_allocator *allocator) {
    pir_shared_features *s = shared;
    const uint32_t vertices = compound->vertex_start[compound->count], faces = compound->face_start[compound->count];
    uint32_t *first_vertex = PIR_NEW(allocator, uint32_t, vertices), *first_plane = PIR_NEW(allocator, uint32_t, faces);
    *s = (pir_shared_features){.vertex = PIR_NEW(allocator, uint32_t, vertices),
                               .plane = PIR_NEW(allocator, uint32_t, faces)};
    bool done = first_vertex && first_plane && s->vertex && s->plane;
    if (done) {
        struct exact_scratch e;
        scratch_init(&e);
        number_vertices(s, compound, first_vertex, &e);
        number_planes(s, compound, first_plane, &e);
        s->words = s->vertices / 64 + 1;
        s->on = PIR_ZEROED(allocator, uint64_t, (size_t)s->planes * s->words);
        s->inner_face = PIR_ZEROED(allocator, bool, faces);
        s->outer_plane = PIR_ZEROED(allocator, bool, s->planes);
        s->inner_vertex = PIR_ZEROED(allocator, bool, s->vertices);
        done = s->on && s->inner_face && s->outer_plane && s->inner_vertex;
        if (done) {
            find_incidences(s, compound, first_vertex, first_plane, &e);
            find_inner(s, compound);
        }
        scratch_clear(&e);
    }
    PIR_FREE(allocator, first_plane, faces);
    PIR_FREE(allocator, first_vertex, vertices);
    return done;
}

void pir_shared_features_finish(pir_shared_features *shared, const pir_compound *compound,
                                const pir_allocator *allocator) {
    PIR_FREE(allocator, shared->vertex, compound->vertex_start[compound->count]);
    PIR_FREE(allocator, shared->plane, compound->face_start[compound->count]);
    PIR_FREE(allocator, shared->on, (size_t)shared->planes * shared->words);
    PIR_FREE(allocator, shared->inner_face, compound->face_start[compound->count]);
    PIR_FREE(allocator, shared->outer_plane, shared->planes);
    PIR_FREE(allocator, shared->inner_vertex, shared->vertices);
}
