/* SPDX-License-Identifier: MIT */
/* Walks and rollbacks, read; see stage_play.h. */
#include "stage_play.h"

#include <math.h>
#include <stdlib.h>

#include "vec.h"

/* The capsule that holds a convex shape which is higher than wide: its radius, and its spine as a segment. */
static bool make_capsule(const struct fields *body, const struct world_shape *shape, struct stage_walk *walk) {
    double wide = 0, low = HUGE_VAL, high = -HUGE_VAL;
    for (uint32_t i = 0; i < pir_polytope_vertex_count(shape->piece[0]); i++) {
        const pir_vec3 v = pir_polytope_vertex(shape->piece[0], i);
        wide = fmax(wide, vec_length((pir_vec3){v.x, v.y, 0}));
        low = fmin(low, v.z);
        high = fmax(high, v.z);
    }
    walk->radius = wide;
    if (!(high - low > 2 * wide))
        return fields_fail(body, "shape", "is not higher than wide; a body that walks is upright");
    const pir_vec3 ends[2] = {{0, 0, low + wide}, {0, 0, high - wide}};
    const pir_status status = pir_polytope_create(ends, 2, NULL, &walk->spine);
    return status == PIR_OK || fields_fail(body, "walk", "%s", pir_status_text(status));
}

static bool read_points(const struct fields *body, struct stage_walk *walk) {
    const cJSON *array = fields_array(body, "walk");
    if (!array)
        return false;
    const int count = cJSON_GetArraySize(array);
    walk->point = calloc((size_t)count, sizeof *walk->point);
    if (!walk->point)
        return fields_fail(body, "walk", "out of memory");
    for (const cJSON *item = array->child; item; item = item->next) {
        const cJSON *x = cJSON_GetArrayItem(item, 0), *y = cJSON_GetArrayItem(item, 1);
        if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 2 || !cJSON_IsNumber(x) || !cJSON_IsNumber(y) ||
            !isfinite(x->valuedouble) || !isfinite(y->valuedouble))
            return fields_fail(body, "walk", "element %u is no array of 2 finite numbers", (unsigned)walk->count);
        walk->point[walk->count][0] = x->valuedouble;
        walk->point[walk->count++][1] = y->valuedouble;
    }
    return true;
}

bool stage_play_walk(const struct fields *body, struct stage *stage, uint32_t number) {
    const struct world_body *of = &stage->body[number].body;
    if (!cJSON_HasObjectItem(body->object, "walk"))
        return !cJSON_HasObjectItem(body->object, "speed") || fields_fail(body, "speed", "is of bodies that walk");
    struct stage_walk *grown = realloc(stage->walk, (stage->walk_count + (size_t)1) * sizeof *grown);
    if (!grown)
        return fields_fail(body, "walk", "out of memory");
    stage->walk = grown;
    struct stage_walk *walk = &stage->walk[stage->walk_count++];
    *walk = (struct stage_walk){.body = number, .speed = 1.5};
    if (of->kind != PIR_BODY_KINEMATIC || world_shape_is_surface(of->shape) || of->shape->count != 1 || of->sensor)
        return fields_fail(body, "walk", "is of kinematic bodies, convex and no sensors");
    return read_points(body, walk) && fields_number(body, "speed", 0, 100, &walk->speed) &&
           make_capsule(body, of->shape, walk);
}

static bool read_back(const struct fields *one, const struct stage *stage, double after, struct stage_back *back) {
    static const char *const known[] = {"at", "to", "body", "velocity", NULL};
    double at = -1, to = -1, body = -1, velocity[3] = {0};
    if (!fields_known(one, known) || !fields_number(one, "at", 0, 3600, &at) ||
        !fields_number(one, "to", 0, 3600, &to) || !fields_number(one, "body", 0, UINT32_MAX, &body) ||
        !fields_numbers(one, "velocity", 3, velocity))
        return false;
    if (at < 0 || to < 0)
        return fields_fail(one, at < 0 ? "at" : "to", "is missing");
    *back = (struct stage_back){(uint32_t)nearbyint(STAGE_RATE * at),
                                (uint32_t)nearbyint(STAGE_RATE * to),
                                UINT32_MAX,
                                {velocity[0], velocity[1], velocity[2]}};
    if (back->to >= back->at || back->at <= after)
        return fields_fail(one, NULL, "goes from %g s to %g s; times come in order, and a rollback goes back", at, to);
    if ((body >= 0) != cJSON_HasObjectItem(one->object, "velocity"))
        return fields_fail(one, NULL, "has a body or a velocity, and not both");
    if (body < 0)
        return true;
    if (body >= stage->body_count || body != nearbyint(body) ||
        stage->body[(uint32_t)body].body.kind == PIR_BODY_STATIC)
        return fields_fail(one, "body", "%g is the number of no body that moves", body);
    back->body = (uint32_t)body;
    return true;
}

bool stage_play_backs(const struct fields *all, struct stage *stage) {
    if (!cJSON_HasObjectItem(all->object, "rollbacks"))
        return true;
    const cJSON *array = fields_array(all, "rollbacks");
    if (!array)
        return false;
    const int count = cJSON_GetArraySize(array);
    stage->back = calloc((size_t)count, sizeof *stage->back);
    if (!stage->back)
        return fields_fail(all, "rollbacks", "out of memory");
    for (int i = 0; i < count; i++) {
        const struct fields one = fields_element(all, "rollbacks", i);
        if (!read_back(&one, stage, i > 0 ? stage->back[i - 1].at : 0, &stage->back[i]))
            return false;
        stage->back_count++;
    }
    return true;
}
