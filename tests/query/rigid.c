/* SPDX-License-Identifier: MIT */
/* See rigid.h. */
#include "query/rigid.h"

#include "support/test.h"

#include <math.h>
#include <stdbool.h>

#include "query/query_of.h"
#include "support/vectors.h"

#define GRAVITY    9.81
#define FRICTION   0.5
#define ITERATIONS 30
#define MARGIN     0.02 /* contacts are found up to this distance */
#define SLOP       5e-4 /* penetration that is not corrected */
#define PUSH       0.1  /* the part of the remaining penetration that one frame corrects */

/* --- rotations --- */

pir_quat rigid_product(pir_quat a, pir_quat b) {
    return (pir_quat){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

pir_quat rigid_inverse(pir_quat q) {
    return (pir_quat){-q.x, -q.y, -q.z, q.w};
}

pir_vec3 rigid_turn(pir_quat q, pir_vec3 v) {
    return test_turn(q, v, 1);
}

pir_quat rigid_turn_to(pir_vec3 from, pir_vec3 to) {
    pir_vec3 c = test_cross(from, to);
    double w = 1 + test_dot(from, to), length = sqrt(test_dot(c, c) + w * w);
    return (pir_quat){c.x / length, c.y / length, c.z / length, w / length};
}

static void turn_by(pir_quat *q, pir_vec3 spin, double seconds) {
    double angle = test_length(spin) * seconds, part = angle > 0 ? sin(angle / 2) / test_length(spin) : 0;
    pir_quat turned = rigid_product((pir_quat){spin.x * part, spin.y * part, spin.z * part, cos(angle / 2)}, *q);
    double length = sqrt(turned.x * turned.x + turned.y * turned.y + turned.z * turned.z + turned.w * turned.w);
    *q = (pir_quat){turned.x / length, turned.y / length, turned.z / length, turned.w / length};
}

/* --- bodies --- */

static void invert(double m[3][3]) {
    double c[3][3], det = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, b = (j + 2) % 3, d = (i + 1) % 3, e = (i + 2) % 3;
            c[i][j] = m[a][d] * m[b][e] - m[a][e] * m[b][d];
        }
    for (int i = 0; i < 3; i++)
        det += m[0][i] * c[i][0];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] = c[i][j] / det;
}

/* Volume, middle and second moments by tetrahedra from the origin; then the inverse mass and inertia. */
static void weigh(rigid_body *body, double density) {
    const pir_polytope *p = body->shape;
    double volume = 0, second[3][3] = {{0}}, first[3] = {0};
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        uint32_t corner[256], n = pir_polytope_facet_size(p, f);
        assert_true(n <= 256);
        pir_polytope_facet(p, f, corner);
        for (uint32_t i = 1; i + 1 < n; i++) {
            pir_vec3 v[3] = {pir_polytope_vertex(p, corner[0]), pir_polytope_vertex(p, corner[i]),
                             pir_polytope_vertex(p, corner[i + 1])};
            double part = test_dot(v[0], test_cross(v[1], v[2])) / 6;
            double at[4][3] = {{0, 0, 0}, {v[0].x, v[0].y, v[0].z}, {v[1].x, v[1].y, v[1].z}, {v[2].x, v[2].y, v[2].z}};
            volume += part;
            for (int k = 0; k < 3; k++) {
                double sum = at[1][k] + at[2][k] + at[3][k];
                first[k] += part * sum / 4;
                for (int l = 0; l < 3; l++) {
                    double sum_l = at[1][l] + at[2][l] + at[3][l];
                    second[k][l] +=
                        part / 20 * (sum * sum_l + at[1][k] * at[1][l] + at[2][k] * at[2][l] + at[3][k] * at[3][l]);
                }
            }
        }
    }
    double mass = density * volume, trace = second[0][0] + second[1][1] + second[2][2];
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(first[k]) < 1e-12 * volume);
        for (int l = 0; l < 3; l++)
            body->inertia[k][l] = density * ((k == l ? trace : 0) - second[k][l]);
    }
    invert(body->inertia);
    body->inverse_mass = 1 / mass;
}

void rigid_add(rigid_world *world, pir_polytope *shape, double density, pir_vec3 place, pir_quat rotation) {
    assert_true(world->bodies < RIGID_BODIES);
    rigid_body *body = &world->body[world->bodies++];
    *body = (rigid_body){.shape = shape, .rotation = rotation, .place = place};
    if (density > 0)
        weigh(body, density);
}

void rigid_start(rigid_world *world) {
    for (uint32_t p = 0; p < world->bodies; p++)
        for (uint32_t q = 0; q < p; q++) {
            if (world->body[p].inverse_mass == 0 && world->body[q].inverse_mass == 0)
                continue;
            rigid_pair *pair = &world->pair[world->pairs++];
            *pair = (rigid_pair){.p = p, .q = q};
            test_query_make(world->body[p].shape, world->body[q].shape, (pir_quat){0, 0, 0, 1}, &pair->sum,
                            &pair->query);
        }
}

void rigid_clear(rigid_world *world) {
    for (uint32_t i = 0; i < world->pairs; i++)
        test_query_free(world->pair[i].query, world->pair[i].sum);
    for (uint32_t i = 0; i < world->bodies; i++)
        pir_polytope_release(world->body[i].shape);
}

double rigid_speed(const rigid_body *body) {
    double reach = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(body->shape); v++)
        reach = fmax(reach, test_length(pir_polytope_vertex(body->shape, v)));
    return test_length(body->velocity) + reach * test_length(body->spin);
}

/* The inverse inertia in the body's rotation, times v. */
static pir_vec3 yield(const rigid_body *body, pir_vec3 v) {
    pir_vec3 b = test_turn(body->rotation, v, -1);
    double in[3] = {b.x, b.y, b.z}, out[3];
    for (int k = 0; k < 3; k++)
        out[k] = body->inertia[k][0] * in[0] + body->inertia[k][1] * in[1] + body->inertia[k][2] * in[2];
    return rigid_turn(body->rotation, (pir_vec3){out[0], out[1], out[2]});
}

/* --- contacts --- */

static bool same_point(pir_vec3 a, pir_vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void set_contact(rigid_pair *pair, const rigid_body *p, const rigid_body *q, const pir_contact *from,
                        rigid_contact *to) {
    pir_vec3 middle = test_add(test_add(test_zero, from->point_p, 0.5), from->point_q, 0.5);
    pir_vec3 at = test_add(q->place, rigid_turn(q->rotation, middle), 1), n = pair->normal;
    pir_vec3 across = test_cross(n, fabs(n.x) < 0.6 ? (pir_vec3){1, 0, 0} : (pir_vec3){0, 1, 0});
    *to = (rigid_contact){.id = from->id, .distance = from->distance};
    to->arm_p = test_add(at, p->place, -1);
    to->arm_q = test_add(at, q->place, -1);
    to->axis[0] = n;
    to->axis[1] = test_add(test_zero, across, 1 / test_length(across));
    to->axis[2] = test_cross(n, to->axis[1]);
    for (int d = 0; d < 3; d++) {
        pir_vec3 lever_p = test_cross(to->arm_p, to->axis[d]), lever_q = test_cross(to->arm_q, to->axis[d]);
        to->turn_p[d] = yield(p, lever_p);
        to->turn_q[d] = yield(q, lever_q);
        to->softness[d] =
            p->inverse_mass + q->inverse_mass + test_dot(lever_p, to->turn_p[d]) + test_dot(lever_q, to->turn_q[d]);
    }
}

/* Finds the contacts of a pair, with the impulses of contacts of the same id in the frame before. */
static void find_contacts(rigid_world *world, rigid_pair *pair) {
    const rigid_body *p = &world->body[pair->p], *q = &world->body[pair->q];
    pir_query_input input = pir_query_input_default();
    pir_query_result answer;
    pir_contact contact[RIGID_CONTACTS];
    rigid_contact old[RIGID_CONTACTS];
    size_t count = 0, olds = pair->count;
    for (size_t i = 0; i < olds; i++)
        old[i] = pair->contact[i];
    pair->count = 0;
    input.translation = test_turn(q->rotation, test_add(p->place, q->place, -1), -1);
    input.margin = input.cutoff = MARGIN;
    assert_int_equal(pir_sum_rotate(pair->sum, rigid_product(rigid_inverse(q->rotation), p->rotation), PIR_METHOD_AUTO),
                     PIR_OK);
    assert_int_equal(pir_query_signed_distance(pair->query, &input, &pair->cache, &answer), PIR_OK);
    assert_int_equal(pir_query_manifold(pair->query, &input, &answer, RIGID_CONTACTS, contact, &count), PIR_OK);
    if (answer.outcome == PIR_BEYOND_CUTOFF || answer.distance > MARGIN)
        return;
    bool held = false;
    pair->normal = rigid_turn(q->rotation, answer.normal);
    for (size_t i = 0; i < count; i++) {
        rigid_contact *to = &pair->contact[pair->count++];
        set_contact(pair, p, q, &contact[i], to);
        for (size_t k = 0; k < olds; k++)
            if (old[k].id == to->id)
                for (int d = 0; d < 3; d++)
                    to->impulse[d] = old[k].impulse[d];
        held |= contact[i].distance == answer.distance && same_point(contact[i].point_p, answer.point_p) &&
                same_point(contact[i].point_q, answer.point_q);
    }
    world->asked++;
    world->missed += !held;
    world->most = count > world->most ? count : world->most;
}

/* --- impulses --- */

/* The two bodies of a contact and whether velocities or pushes are meant. */
struct meeting {
    rigid_body *p, *q;
    bool push;
};

static double closing(const struct meeting *m, const rigid_contact *c, pir_vec3 d) {
    const rigid_body *p = m->p, *q = m->q;
    pir_vec3 of_p =
        test_add(m->push ? p->push : p->velocity, test_cross(m->push ? p->push_spin : p->spin, c->arm_p), 1);
    pir_vec3 of_q =
        test_add(m->push ? q->push : q->velocity, test_cross(m->push ? q->push_spin : q->spin, c->arm_q), 1);
    return test_dot(test_add(of_p, of_q, -1), d);
}

static void apply_to(rigid_body *body, bool push, pir_vec3 d, pir_vec3 turn, double impulse) {
    pir_vec3 *velocity = push ? &body->push : &body->velocity, *spin = push ? &body->push_spin : &body->spin;
    *velocity = test_add(*velocity, d, impulse * body->inverse_mass);
    *spin = test_add(*spin, turn, impulse);
}

static void apply(const struct meeting *m, const rigid_contact *c, int d, double impulse) {
    apply_to(m->p, m->push, c->axis[d], c->turn_p[d], impulse);
    apply_to(m->q, m->push, c->axis[d], c->turn_q[d], -impulse);
}

/* Changes the impulse along d so that the closing speed becomes `wanted`, the sum staying within low and high. */
static void correct(const struct meeting *m, const rigid_contact *c, int d, double wanted, double low, double high,
                    double *impulse) {
    double before = *impulse;
    *impulse = fmin(high, fmax(low, before + (wanted - closing(m, c, c->axis[d])) / c->softness[d]));
    apply(m, c, d, *impulse - before);
}

static void solve(rigid_world *world, rigid_pair *pair, double seconds) {
    struct meeting m = {&world->body[pair->p], &world->body[pair->q], false}, push = {m.p, m.q, true};
    for (size_t i = 0; i < pair->count; i++) {
        rigid_contact *c = &pair->contact[i];
        // what is apart may close the gap, and no more
        correct(&m, c, 0, -fmax(c->distance, 0) / seconds, 0, HUGE_VAL, &c->impulse[0]);
        double most = FRICTION * c->impulse[0];
        for (int d = 1; d < 3; d++)
            correct(&m, c, d, 0, -most, most, &c->impulse[d]);
        double deep = -c->distance - SLOP;
        if (deep > 0)
            correct(&push, c, 0, PUSH * deep / seconds, 0, HUGE_VAL, &c->push);
    }
}

void rigid_step(rigid_world *world, double seconds) {
    for (uint32_t i = 0; i < world->bodies; i++) {
        rigid_body *body = &world->body[i];
        body->push = body->push_spin = test_zero;
        if (body->inverse_mass > 0)
            body->velocity.z -= GRAVITY * seconds;
    }
    for (uint32_t i = 0; i < world->pairs; i++) {
        rigid_pair *pair = &world->pair[i];
        find_contacts(world, pair);
        struct meeting m = {&world->body[pair->p], &world->body[pair->q], false};
        for (size_t k = 0; k < pair->count; k++) {
            rigid_contact *c = &pair->contact[k];
            for (int d = 0; d < 3; d++)
                apply(&m, c, d, c->impulse[d]);
        }
    }
    for (int round = 0; round < ITERATIONS; round++)
        for (uint32_t i = 0; i < world->pairs; i++)
            solve(world, &world->pair[i], seconds);
    for (uint32_t i = 0; i < world->bodies; i++) {
        rigid_body *body = &world->body[i];
        body->place = test_add(body->place, test_add(body->velocity, body->push, 1), seconds);
        turn_by(&body->rotation, test_add(body->spin, body->push_spin, 1), seconds);
    }
}
