/* SPDX-License-Identifier: MIT */
/*
 * Bodies that slide without friction over flat floors, beside engines in their own worlds: mesh_sliding.csv has a line
 * for each floor, body, speed and engine: the contacts that pushed, those whose normal is off the floor's by more than
 * 1e-9 and 1e-3, the greatest part of the speed that was lost, and how high the body hopped. Floors and bodies are
 * those of tests/mesh/sliding_floors.h, and 1,800 prisms as convex hulls besides.
 *
 *     bench_sliding FOLDER
 */
#include <math.h>
#include <stdlib.h>

#include <pirouette/scene.h>

#include "results.h"
#include "sliding_peer.h"

#define FRAMES   300
#define CONTACTS 256
#define SURFACES 256
#define MARGIN   0.04
#define GAP      0.005
#define HULLS    FLOOR_RIDGE /* the floor that comes after the flat ones */
#define PRISMS   2           /* its prisms are those of this floor */

static void check(pir_status status) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench_sliding: %s\n", pir_status_text(status));
    exit(2);
}

/* --- floors as triangles --- */

static void *checked(void *block) {
    if (!block)
        check(PIR_ERR_MEMORY);
    return block;
}

static slide_part part_of(const pir_posed_surface *posed) {
    pir_trimesh_info mesh;
    pir_height_info field;
    uint32_t count;
    if (posed->surface.mesh) {
        pir_trimesh_describe(posed->surface.mesh, &mesh);
        count = mesh.triangles;
    } else {
        pir_height_field_describe(posed->surface.field, &field);
        count = 2 * (field.columns - 1) * (field.rows - 1);
    }
    slide_part part = {checked(calloc(count, sizeof *part.corner)), count};
    for (uint32_t t = 0; t < count; t++) {
        pir_triangle_corners corners;
        check(posed->surface.mesh ? pir_trimesh_triangle(posed->surface.mesh, t, &corners)
                                  : pir_height_field_triangle(posed->surface.field, t, &corners));
        for (int k = 0; k < 3; k++)
            part.corner[t][k] = pir_pose_apply(posed->pose, corners.corner[k]);
    }
    return part;
}

static slide_floor floor_of(const sliding_floor *from, bool hulls) {
    slide_floor floor = {checked(calloc(from->count, sizeof *floor.part)), from->count, hulls};
    for (uint32_t i = 0; i < from->count; i++)
        floor.part[i] = part_of(&from->surface[i]);
    return floor;
}

static void floor_free(slide_floor *floor) {
    for (uint32_t i = 0; i < floor->count; i++)
        free(floor->part[i].corner);
    free(floor->part);
}

/* --- ours --- */

typedef struct ours {
    const sliding_floor *floor;
    pir_workspace *workspace;
    pir_scene *scene; /* of hulls; or NULL */
    uint32_t body;
} ours;

static size_t contacts_of_meshes(const ours *o, const slider *body, pir_surface_contact contacts[CONTACTS]) {
    pir_posed_surface surfaces[SURFACES];
    const pir_polytope *beside[SLIDER_PIECES];
    pir_surface_contact_input input = pir_surface_contact_input_default();
    const double x = body->pose.translation.x;
    size_t count = 0;
    for (uint32_t k = 0; k < body->pieces; k++)
        beside[k] = body->piece[k];
    input.pose = body->pose;
    input.radius = body->radius;
    input.margin = MARGIN;
    input.beside = beside;
    input.beside_count = body->pieces;
    input.surfaces = surfaces;
    input.surface_count = floor_between(o->floor, x - 0.8, x + 0.8, surfaces, SURFACES);
    for (uint32_t k = 0; k < body->pieces; k++) {
        pir_surface_contact_result result;
        check(pir_surface_contacts(body->piece[k], o->workspace, &input, CONTACTS - count, contacts + count, &result));
        count += result.contacts;
    }
    return count;
}

static size_t contacts_of_scene(const ours *o, const slider *body, pir_surface_contact contacts[CONTACTS]) {
    const pir_scene_move move = {o->body, body->pose};
    size_t count, found = 0;
    check(pir_scene_update(o->scene, &move, 1));
    const pir_scene_event *event = pir_scene_events(o->scene, &count);
    for (size_t i = 0; i < count; i++) {
        // the floor was added first: normals point down
        const pir_vec3 n = {-event[i].normal.x, -event[i].normal.y, -event[i].normal.z};
        for (uint32_t k = 0; k < event[i].contact_count && found < CONTACTS; k++)
            contacts[found++] = (pir_surface_contact){
                .point_p = event[i].contacts[k].point_q, .normal = n, .distance = event[i].contacts[k].distance};
    }
    return found;
}

static void make_scene(ours *o, const slide_floor *floor, const slider *body) {
    pir_scene_options options = pir_scene_options_default();
    pir_body_options part = pir_body_options_default(), added = part;
    uint32_t number;
    options.margin = MARGIN;
    options.unions = true;
    check(pir_scene_create(&options, &o->scene));
    part.kind = PIR_BODY_STATIC;
    part.piece_count = 1;
    for (uint32_t i = 0; i < floor->count; i++) {
        pir_polytope *hull;
        check(pir_polytope_create(floor->part[i].corner[0], 3 * (size_t)floor->part[i].count, NULL, &hull));
        part.pieces = &hull;
        check(pir_scene_add(o->scene, &part, &number));
        pir_polytope_release(hull);
    }
    added.pieces = body->piece;
    added.piece_count = body->pieces;
    added.radius = body->radius;
    added.pose = body->pose;
    check(pir_scene_add(o->scene, &added, &o->body));
}

static void our_slide(const sliding_floor *from, const slide_floor *floor, slider *body, double speed, uint32_t frames,
                      slide_result *ret_result) {
    ours o = {.floor = from};
    const double start = body->pose.translation.z;
    check(pir_workspace_create(NULL, &o.workspace));
    if (floor->hulls)
        make_scene(&o, floor, body);
    *ret_result = (slide_result){0};
    body->velocity = (pir_vec3){speed, 0.05 * speed, 0};
    for (uint32_t frame = 0; frame < frames; frame++) {
        pir_surface_contact contacts[CONTACTS];
        (void)slide_goes_round(&body->pose.translation);
        const size_t count =
            floor->hulls ? contacts_of_scene(&o, body, contacts) : contacts_of_meshes(&o, body, contacts);
        for (size_t i = 0; i < count; i++)
            slide_count(ret_result, contacts[i].normal.x, contacts[i].normal.y, 1);
        slider_step(body, contacts, count, GAP);
        slide_note(ret_result, body->velocity.x, body->velocity.y, speed, body->pose.translation.z - start);
    }
    pir_scene_destroy(o.scene);
    pir_workspace_destroy(o.workspace);
}

/* --- the table --- */

static const struct {
    const char *name;
    slide_run *slide;
} peers[] = {
#ifdef PIR_HAVE_BOX3D
    {"box3d", box3d_slide},
#endif
#ifdef PIR_HAVE_BULLET
    {"Bullet", bullet_slide},
#endif
#ifdef PIR_HAVE_JOLT
    {"Jolt", jolt_slide},
#endif
    {NULL, NULL},
};

static void print(FILE *csv, const char *engine, const char *floor, const char *body, double speed,
                  const slide_result *r) {
    const unsigned long long contacts = r->contacts, off = r->off, ghosts = r->ghosts;
    fprintf(csv, "%s,%s,%s,%g,%llu,%llu,%llu,%.3g,%.3g\n", floor, body, engine, speed, contacts, off, ghosts, r->lost,
            r->hop);
    printf("%s on %s at %g m/s, %s: %llu of %llu contacts are ghosts, %llu off by 1e-9, speed off by %.2g, hop %.2g\n",
           body, floor, speed, engine, ghosts, contacts, off, r->lost, r->hop);
}

static void run(FILE *csv, int kind, uint32_t frames) {
    static const double speeds[3] = {1, 7, 30};
    sliding_floor from;
    floor_make(&from, kind == HULLS ? PRISMS : kind);
    slide_floor floor = floor_of(&from, kind == HULLS);
    const char *name = kind == HULLS ? "prisms as hulls" : from.name;
    for (int shape = 0; shape < SLIDER_KINDS; shape++)
        for (int i = 0; i < 3; i++) {
            slider body;
            slide_result result;
            slider_make(&body, shape, GAP);
            body.pose.translation.x = 0.13;
            body.pose.translation.y = 0.07;
            for (int k = 0; peers[k].slide; k++) {
                peers[k].slide(&floor, &body, speeds[i], frames, &result);
                print(csv, peers[k].name, name, body.name, speeds[i], &result);
            }
            our_slide(&from, &floor, &body, speeds[i], frames, &result);
            print(csv, "Pirouette", name, body.name, speeds[i], &result);
            slider_clear(&body);
        }
    floor_free(&floor);
    floor_clear(&from);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_sliding FOLDER\n");
        return 2;
    }
    const struct results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "mesh_sliding.csv");
    fprintf(csv, "floor,body,engine,speed,contacts,off,ghosts,lost,hop\n");
    for (int kind = 0; kind <= HULLS; kind++)
        run(csv, kind, results_count(FRAMES));
    results_close(csv, "mesh_sliding.csv");
    return 0;
}
