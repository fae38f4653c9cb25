/* SPDX-License-Identifier: MIT */
/* Operands in the frame of an exponent, kept by their polytopes: see body.h. */
#include "query/frame/body.h"

#include <assert.h>
#include <limits.h>

/* Kinds of what is attachment. */
static const char a_size, a_body;

struct size {
    pir_attachment attachment;
    int exponent;
};

static void destroy_size(pir_attachment *attachment, const pir_allocator *a) {
    struct size *size = (struct size *)attachment;
    PIR_FREE(a, size, 1);
}

/* The offsets and the shapes behind them, in doubles. */
static size_t offsets_and_shapes(const pir_polytope *p) {
    static_assert(sizeof(pir_kept_shape) == 2 * sizeof(double), "shapes take whole doubles");
    return (size_t)p->facet_count * 3;
}

static void destroy_body(pir_attachment *attachment, const pir_allocator *a) {
    pir_kept_body *body = (pir_kept_body *)attachment;
    PIR_FREE(a, body->body.vertex, (size_t)body->body.polytope->vertex_count + 1);
    pir_around_free(body->body.polytope, &body->around);
    PIR_FREE(a, body->body.offset, offsets_and_shapes(body->body.polytope));
    PIR_FREE(a, body, 1);
}

/* Limbs for a vertex and one more. */
static mp_limb_t *room_new(const pir_polytope *p) {
    return PIR_NEW(&p->allocator, mp_limb_t, (size_t)p->exact_vertex.stride + 1);
}

static void room_free(const pir_polytope *p, mp_limb_t *room) {
    PIR_FREE(&p->allocator, room, (size_t)p->exact_vertex.stride + 1);
}

pir_status pir_kept_exponent(pir_polytope *p, int *ret_exponent) {
    pir_attachment *attachment = pir_polytope_attachment(p, &a_size, 0);
    if (!attachment) {
        struct size *made = PIR_ZEROED(&p->allocator, struct size, 1);
        mp_limb_t *room = room_new(p);
        if (!made || !room) {
            room_free(p, room);
            PIR_FREE(&p->allocator, made, 1);
            return PIR_ERR_MEMORY;
        }
        made->attachment = (pir_attachment){.kind = &a_size, .destroy = destroy_size};
        made->exponent = pir_body_exponent(p, room);
        room_free(p, room);
        attachment = pir_polytope_attach(p, &made->attachment);
    }
    *ret_exponent = ((struct size *)attachment)->exponent;
    return PIR_OK;
}

/* The mean of the vertices, each counted by a weight of its own. */
static pir_vec3 inner_of(const pir_body *body) {
    pir_vec3 sum = {0, 0, 0};
    double all = 0, weight = 0.5;
    for (uint32_t v = 0; v < body->polytope->vertex_count; v++) {
        // multiples of the golden ratio spread evenly
        weight += 0.6180339887498949;
        weight -= weight >= 1.5 ? 1 : 0;
        sum = pir_vec_add(sum, pir_vec_scale(body->vertex[v], weight));
        all += weight;
    }
    return pir_vec_scale(sum, 1 / all);
}

/* How far inside the middle is of all facets' planes, less rounding; negative where it may be in none of the body. */
static double inside_of(const pir_body *body) {
    double least = body->polytope->dimension == 3 ? HUGE_VAL : -HUGE_VAL;
    for (uint32_t f = 0; f < body->polytope->facet_count; f++)
        least = fmin(least, body->offset[f] - 0x1p-46 * body->size);
    return least > 0 ? least : -HUGE_VAL;
}

/* The least sine by which an edge falls along the mean of the normals at its vertex; 0 where that is not known. */
static double point_of(const pir_polytope *p) {
    double least = 1;
    for (uint32_t v = 0; v < p->vertex_count && p->dimension == 3; v++) {
        pir_vec3 sum = {0, 0, 0};
        double most = -1;
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
            sum = pir_vec_add(sum, p->normal[p->left[h]]);
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
            most = fmax(most, pir_vec_dot(sum, p->direction[h]));
        least = fmin(least, -most / sqrt(pir_vec_dot(sum, sum)));
    }
    return p->dimension == 3 && least > 0x1p-20 ? least * (1 - 0x1p-20) : 0;
}

static pir_status make_body(pir_polytope *p, int exponent, pir_kept_body **ret_body) {
    const pir_allocator *a = &p->allocator;
    pir_kept_body *made = PIR_ZEROED(a, pir_kept_body, 1);
    if (!made)
        return PIR_ERR_MEMORY;
    made->attachment = (pir_attachment){.kind = &a_body, .key = exponent, .destroy = destroy_body};
    made->body.polytope = p;
    // vector loads of four doubles may reach past the last
    made->body.vertex = PIR_ZEROED(a, pir_vec3, (size_t)p->vertex_count + 1);
    made->body.offset = PIR_NEW(a, double, offsets_and_shapes(p));
    mp_limb_t *room = room_new(p);
    pir_status status = PIR_ERR_MEMORY;
    if (made->body.vertex && made->body.offset && room)
        status = pir_body_fill(&made->body, exponent, room);
    room_free(p, room);
    if (status == PIR_OK && pir_around_has(p)) {
        made->body.around = &made->around;
        status = pir_around_make(p, made->body.vertex, &made->around) ? PIR_OK : PIR_ERR_MEMORY;
    }
    if (status != PIR_OK) {
        destroy_body(&made->attachment, a);
        return status;
    }
    for (uint32_t f = 0; f < p->facet_count; f++)
        pir_kept_shape_clear(&pir_body_shapes(&made->body)[f]);
    made->inner = inner_of(&made->body);
    made->inside = inside_of(&made->body);
    double point = point_of(p);
    made->slip = point > 0 ? made->body.size / point : -1;
    *ret_body = made;
    return PIR_OK;
}

pir_status pir_kept_body_of(pir_polytope *p, int exponent, const pir_kept_body **ret_body) {
    pir_attachment *attachment = pir_polytope_attachment(p, &a_body, exponent);
    if (!attachment) {
        pir_kept_body *made = NULL;
        pir_status status = make_body(p, exponent, &made);
        if (status != PIR_OK)
            return status;
        attachment = pir_polytope_attach(p, &made->attachment);
    }
    *ret_body = (const pir_kept_body *)attachment;
    return PIR_OK;
}

pir_status pir_frame_set_bodies(pir_frame *frame, pir_polytope *p, pir_polytope *q) {
    int of_p, of_q;
    pir_status status = pir_kept_exponent(p, &of_p);
    if (status == PIR_OK)
        status = pir_kept_exponent(q, &of_q);
    if (status != PIR_OK)
        return status;
    int exponent = pir_frame_exponent(of_p, of_q, p, q);
    const pir_kept_body *body_p, *body_q;
    status = pir_kept_body_of(p, exponent, &body_p);
    if (status == PIR_OK)
        status = pir_kept_body_of(q, exponent, &body_q);
    if (status != PIR_OK)
        return status;
    pir_frame_set_exponent(frame, exponent);
    pir_frame_take_bodies(frame, body_p, body_q);
    frame->is_set = false;
    return PIR_OK;
}
