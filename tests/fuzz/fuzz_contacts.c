/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a body over triangles. All that is told hangs together: points over each other, the deepest first,
 * numbers that differ, ways out that end where nothing is met. Without a radius the state is that of integers, and
 * bodies that are apart have all contacts of the union and none else (oracle/contacts.h).
 *
 * The bytes: a way of numbers, an exponent, points of the body, triangles with their sides, two poses, radius, margin.
 * See fuzz_sum.c for how to run an engine.
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include <pirouette/trimesh_contact.h>

#include "fuzz/input.h"
#include "oracle/contacts.h"

#define TRIANGLES 4
#define POINTS    6
#define CONTACTS  256

struct stage {
    pir_polytope *body;
    pir_trimesh *mesh;
    pir_vec3 vertex[POINTS], corner[TRIANGLES][3];
    uint32_t vertices, triangles;
    bool one_sided;
    pir_surface_contact contacts[CONTACTS];
    pir_surface_contact_result result;
    double size; /* the greatest coordinate */
};

/* A coordinate that the oracle is done with soon: at most 2^20, a multiple of 2^-40. */
static double coordinate(struct fuzz_input *input, int way, int exponent) {
    double x = fuzz_number(input, way, exponent);
    x = fabs(x) < 0x1p20 ? x : 0;
    return fabs(x) > 0x1p-40 ? x : 0;
}

static pir_vec3 point(struct fuzz_input *input, int way, int exponent) {
    double c[3];
    for (int k = 0; k < 3; k++)
        c[k] = coordinate(input, way, exponent);
    return (pir_vec3){c[0], c[1], c[2]};
}

static double size_of(pir_vec3 x) {
    return fmax(fabs(x.x), fmax(fabs(x.y), fabs(x.z)));
}

static bool make(struct fuzz_input *input, struct stage *s) {
    static const uint32_t corners[3 * TRIANGLES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    int way = fuzz_byte(input) % FUZZ_WAYS, exponent = fuzz_small(input) % 20;
    s->vertices = 1 + fuzz_byte(input) % POINTS;
    s->triangles = 1 + fuzz_byte(input) % TRIANGLES;
    s->one_sided = fuzz_byte(input) % 2;
    for (uint32_t v = 0; v < s->vertices; v++)
        s->vertex[v] = point(input, way, exponent);
    for (uint32_t i = 0; i < 3 * s->triangles; i++)
        s->corner[i / 3][i % 3] = point(input, way, exponent);
    const pir_trimesh_arrays arrays = {.vertices = s->corner,
                                       .vertex_count = 3 * (size_t)s->triangles,
                                       .triangles = corners,
                                       .triangle_count = s->triangles};
    pir_trimesh_options options = pir_trimesh_options_default();
    options.two_sided = !s->one_sided;
    pir_trimesh_info info;
    if (pir_polytope_create(s->vertex, s->vertices, NULL, &s->body) != PIR_OK ||
        pir_trimesh_create(&arrays, &options, NULL, &s->mesh) != PIR_OK)
        return false;
    // a triangle that the mesh leaves out would have to be left out by the oracle too
    pir_trimesh_describe(s->mesh, &info);
    return info.degenerate == 0;
}

static pir_pose some_pose(struct fuzz_input *input) {
    pir_pose pose = {fuzz_rotation(input, (pir_quat){0, 0, 0, 1}), {0, 0, 0}};
    const double q[4] = {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w};
    for (int k = 0; k < 4; k++)
        if (q[k] != 0 && (fabs(q[k]) < 0x1p-40 || fabs(q[k]) > 0x1p40))
            pose.rotation = (pir_quat){0, 0, 0, 1};
    pose.translation = point(input, fuzz_byte(input) % 2, 0);
    return pose;
}

/* What is told of any pose hangs together. */
static void check_told(struct stage *s, const pir_surface_contact_input *input) {
    const pir_surface_contact_result *r = &s->result;
    for (size_t i = 0; i < r->contacts; i++) {
        const pir_surface_contact *c = &s->contacts[i];
        const pir_vec3 n = c->normal, p = c->point_p, q = c->point_q;
        const pir_vec3 off = {q.x + c->distance * n.x - p.x, q.y + c->distance * n.y - p.y,
                              q.z + c->distance * n.z - p.z};
        fuzz_require(isfinite(c->distance) && c->distance <= input->margin, "a contact is within the margin");
        fuzz_require(fabs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-9, "a normal is a unit");
        fuzz_require(size_of(off) <= 1e-9 * s->size, "points are over each other");
        fuzz_require(i == 0 || c->distance >= s->contacts[i - 1].distance, "the deepest are first");
        for (size_t k = 0; k < i; k++)
            fuzz_require(c->id != s->contacts[k].id, "numbers differ");
    }
    fuzz_require(r->state == PIR_OUTSIDE ? r->distance >= 0 : r->distance <= 0, "the distance is of the state");
    fuzz_require(r->state == PIR_OUTSIDE || isfinite(r->distance), "who overlaps is told how far");
    fuzz_require(r->state != PIR_OUTSIDE || size_of(r->way_out) == 0, "no way out of nothing");
    fuzz_require(r->is_out || size_of(r->way_out) == 0, "no way that leads nowhere");
}

static bool is_told(const struct stage *s, pir_vec3 normal, double gap) {
    for (size_t i = 0; i < s->result.contacts; i++) {
        const pir_vec3 n = s->contacts[i].normal, off = {n.x - normal.x, n.y - normal.y, n.z - normal.z};
        if (size_of(off) < 1e-8 && s->contacts[i].distance <= gap + 1e-9 * s->size)
            return true;
    }
    return false;
}

/* Of a body that is apart: all contacts are told, and no ghosts. */
static void check_apart(struct stage *s, oracle_scene *truth, double margin) {
    pir_vec3 normal[TRIANGLES];
    uint32_t found = 0;
    for (uint32_t i = 0; i < s->triangles; i++) {
        double gap;
        if (!oracle_scene_counts(truth, i) || !oracle_scene_contact(truth, i, &normal[found], &gap))
            continue;
        fuzz_require(gap > margin * (1 - 1e-9) || is_told(s, normal[found], gap), "no contact is lost");
        found++;
    }
    for (size_t i = 0; i < s->result.contacts; i++) {
        const pir_vec3 n = s->contacts[i].normal;
        bool is = false;
        for (uint32_t k = 0; k < found && !is; k++)
            is = size_of((pir_vec3){n.x - normal[k].x, n.y - normal[k].y, n.z - normal[k].z}) < 1e-8;
        for (uint32_t k = 0; k < s->triangles && !is; k++)
            is = oracle_scene_exposed(truth, k, n);
        fuzz_require(is, "no ghost is told");
    }
}

static void check_pose(struct stage *s, const pir_surface_contact_input *input) {
    oracle_triangle triangle[TRIANGLES];
    bool one_sided[TRIANGLES];
    const pir_vec3 t = input->pose.translation, way = s->result.way_out;
    for (uint32_t i = 0; i < s->triangles; i++) {
        one_sided[i] = s->one_sided;
        oracle_triangle_init(&triangle[i]);
        oracle_triangle_place(&triangle[i], s->corner[i], input->surfaces[0].pose);
    }
    oracle_scene *truth =
        oracle_scene_make(s->vertex, s->vertices, input->pose.rotation, triangle, one_sided, s->triangles);
    oracle_scene_move(truth, t);
    fuzz_require((int)s->result.state == oracle_scene_state(truth), "the state");
    if (s->result.state == PIR_OUTSIDE)
        check_apart(s, truth, input->margin);
    oracle_scene_move(truth, (pir_vec3){t.x + way.x, t.y + way.y, t.z + way.z});
    fuzz_require(!s->result.is_out || oracle_scene_state(truth) == 0, "a way out ends where nothing is met");
    oracle_scene_free(truth);
    for (uint32_t i = 0; i < s->triangles; i++)
        oracle_triangle_clear(&triangle[i]);
}

static void ask(struct fuzz_input *input, struct stage *s, pir_workspace *workspace) {
    pir_posed_surface surface = {{s->mesh, NULL}, pir_pose_identity()};
    pir_surface_contact_input asked = pir_surface_contact_input_default();
    if (fuzz_byte(input) % 2)
        surface.pose = some_pose(input);
    asked.pose = some_pose(input);
    asked.radius = fuzz_byte(input) % 3 ? 0 : fabs(coordinate(input, 0, 0));
    asked.margin = fabs(coordinate(input, 0, 0));
    asked.surfaces = &surface;
    asked.surface_count = 1;
    s->size = 1 + size_of(asked.pose.translation) + size_of(surface.pose.translation) + asked.radius + asked.margin;
    for (uint32_t v = 0; v < s->vertices; v++)
        s->size = fmax(s->size, size_of(s->vertex[v]));
    for (uint32_t i = 0; i < 3 * s->triangles; i++)
        s->size = fmax(s->size, size_of(s->corner[i / 3][i % 3]));
    fuzz_require(pir_surface_contacts(s->body, workspace, &asked, CONTACTS, s->contacts, &s->result) == PIR_OK,
                 "contacts are told");
    check_told(s, &asked);
    if (asked.radius == 0)
        check_pose(s, &asked);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct fuzz_input input = {data, size, 0};
    struct stage s = {.body = NULL};
    pir_workspace *workspace;
    fuzz_require(pir_workspace_create(NULL, &workspace) == PIR_OK, "a workspace");
    if (make(&input, &s))
        for (int i = 0; i < 2; i++)
            ask(&input, &s, workspace);
    pir_workspace_destroy(workspace);
    pir_polytope_release(s.body);
    pir_trimesh_release(s.mesh);
    return 0;
}
