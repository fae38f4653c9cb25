/* SPDX-License-Identifier: MIT */
/* Stages: see contact_stage.h. */
#include "mesh/contact_stage.h"

#include <math.h>
#include <string.h>

#include "support/test.h"

static bool has_area(const pir_vec3 c[3]) {
    pir_vec3 u = {c[1].x - c[0].x, c[1].y - c[0].y, c[1].z - c[0].z};
    pir_vec3 v = {c[2].x - c[0].x, c[2].y - c[0].y, c[2].z - c[0].z};
    return u.y * v.z != u.z * v.y || u.z * v.x != u.x * v.z || u.x * v.y != u.y * v.x;
}

static pir_trimesh *mesh_of_some(const contact_soup *soup, uint32_t first, uint32_t step, bool two_sided) {
    uint32_t corner[SOUP_MOST][3], count = 0;
    for (uint32_t i = first; i < soup->count; i += step)
        for (uint32_t k = 0; k < 3; k++)
            corner[count / 3][count % 3] = 3 * i + k, count++;
    const pir_trimesh_arrays arrays = {.vertices = soup->corner,
                                       .vertex_count = 3 * (size_t)soup->count,
                                       .triangles = &corner[0][0],
                                       .triangle_count = count / 3};
    pir_trimesh_options options = pir_trimesh_options_default();
    options.two_sided = two_sided;
    pir_trimesh *mesh;
    assert_int_equal(pir_trimesh_create(&arrays, &options, NULL, &mesh), PIR_OK);
    return mesh;
}

/* Leaves out triangles without an area, as meshes do. */
static void drop_flat(contact_soup *soup) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < soup->count; i++)
        if (has_area(soup->corner[i])) {
            memmove(soup->corner[count], soup->corner[i], sizeof soup->corner[i]);
            count++;
        }
    soup->count = count;
}

void stage_make(stage *s, test_random *random, uint64_t number) {
    s->soup = soup_make(random, number);
    soup_jitter(random, &s->soup);
    drop_flat(&s->soup);
    s->soup.split &= s->soup.count > 1;
    s->surfaces = s->soup.split ? 2 : 1;
    bool one_sided[SOUP_MOST];
    oracle_triangle triangle[SOUP_MOST];
    for (uint32_t i = 0; i < s->surfaces; i++) {
        bool two_sided = test_random_below(random, 3) == 0;
        pir_pose pose = {soup_rotation(random), {0, 0, 0}};
        if (i == 0 || test_random_below(random, 2))
            pose.rotation = (pir_quat){0, 0, 0, 1};
        s->mesh[i] = mesh_of_some(&s->soup, i, s->surfaces, two_sided);
        s->surface[i] = (pir_posed_surface){{s->mesh[i], NULL}, pose};
        for (uint32_t k = i; k < s->soup.count; k += s->surfaces) {
            one_sided[k] = !two_sided;
            oracle_triangle_init(&triangle[k]);
            oracle_triangle_place(&triangle[k], s->soup.corner[k], pose);
        }
    }
    s->vertices = soup_body(number / 12, s->vertex);
    s->rotation = soup_rotation(random);
    assert_int_equal(pir_polytope_create(s->vertex, s->vertices, NULL, &s->body), PIR_OK);
    s->truth = oracle_scene_make(s->vertex, s->vertices, s->rotation, triangle, one_sided, s->soup.count);
    for (uint32_t k = 0; k < s->soup.count; k++)
        oracle_triangle_clear(&triangle[k]);
}

void stage_clear(stage *s) {
    oracle_scene_free(s->truth);
    pir_polytope_release(s->body);
    for (uint32_t i = 0; i < s->surfaces; i++)
        pir_trimesh_release(s->mesh[i]);
}

pir_vec3 some_place(test_random *random, const stage *s) {
    static const double heights[9] = {0, 0.0009765625, -0.0009765625, 0.0625, -0.0625, 0.25, -0.25, 0.5, 1e-9};
    double low = HUGE_VAL;
    for (uint32_t v = 0; v < s->vertices; v++)
        low = fmin(low, pir_pose_rotate((pir_pose){s->rotation, {0, 0, 0}}, s->vertex[v]).z);
    pir_vec3 t = {0.125 * test_random_between(random, -14, 14), 0.125 * test_random_between(random, -14, 14),
                  heights[test_random_below(random, 9)] - low};
    if (test_random_below(random, 3) == 0) {
        t.x += ldexp(test_random_unit(random), -10);
        t.y += ldexp(test_random_unit(random), -5);
    }
    if (test_random_below(random, 4) == 0)
        t.z = t.z == 0 ? 0x1p-60 : nextafter(t.z, test_random_below(random, 2) ? 10 : -10);
    return t;
}

pir_surface_contact_input input_of(const stage *s, pir_vec3 t, double margin) {
    pir_surface_contact_input input = pir_surface_contact_input_default();
    input.pose = (pir_pose){s->rotation, t};
    input.margin = margin;
    input.surfaces = s->surface;
    input.surface_count = s->surfaces;
    return input;
}

double apart(pir_vec3 a, pir_vec3 b) {
    return fmax(fabs(a.x - b.x), fmax(fabs(a.y - b.y), fabs(a.z - b.z)));
}
