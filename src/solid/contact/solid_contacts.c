/* SPDX-License-Identifier: MIT */
/*
 * Contacts of bodies in pieces. Invariants:
 *
 * - `surface` has a fan of one-sided triangles for each facet of each piece of Q, in order; facet[i] is triangle i's,
 *   and its material the piece.
 * - Contacts that pir_surface_contacts tells of a piece of P, with the others beside it, are none of a wall of either
 *   body: they are those of the union, and stay what they are. What is done here chooses among them.
 * - Where P overlaps at a ridge that pieces of it share, each has a way out that the other is in, so neither tells a
 *   contact. Then the depth of the bodies is the one contact.
 */
#include <pirouette/solid_contact.h>

#include <math.h>
#include <pirouette/solid_query.h>
#include <pirouette/trimesh_contact.h>

#include "base/memory.h"
#include "base/vec.h"
#include "polytope/polytope.h"

/* Contacts of one piece of P: as many normals as are told, four points each. */
#define OF_PIECE 256

/* Normals this near to one another, by the square of their difference, are one: this chooses points only. */
#define ONE_NORMAL 0x1p-40

/* Not looked at, of a normal that was, and one of those that stand for it. */
enum contact_mark { CONTACT_NEW, CONTACT_OF_NORMAL, CONTACT_CHOSEN };

struct pir_solid_contacts {
    pir_allocator allocator;
    pir_polytope **piece; /* of P */
    uint32_t pieces;
    pir_trimesh *surface;
    pir_solid_query *query; /* of depths */
    uint32_t *facet, triangles;
    pir_surface_contact *told; /* OF_PIECE of them */
    pir_solid_contact *found;
    enum contact_mark *mark; /* per contact found */
    size_t found_room, count;
};

/* --- life --- */

static pir_status take_pieces(pir_solid_contacts *c, const pir_pieces *p) {
    c->pieces = pir_pieces_count(p);
    c->piece = PIR_ZEROED(&c->allocator, pir_polytope *, c->pieces);
    if (!c->piece)
        return PIR_ERR_MEMORY;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < c->pieces && status == PIR_OK; i++)
        status = pir_pieces_polytope(p, i, &c->piece[i]);
    return status;
}

/* The arrays of Q's surface while it is made. */
struct surface_arrays {
    pir_vec3 *vertex;
    uint32_t *corner, *material, vertices, triangles;
};

static void add_piece(pir_solid_contacts *c, const pir_polytope *p, uint32_t piece, struct surface_arrays *to) {
    for (uint32_t f = 0; f < p->facet_count; f++)
        for (uint32_t i = p->loop_start[f] + 1; i + 1 < p->loop_start[f + 1]; i++) {
            const uint32_t loop[3] = {p->loop[p->loop_start[f]], p->loop[i], p->loop[i + 1]};
            for (int k = 0; k < 3; k++)
                to->corner[3 * (size_t)to->triangles + (size_t)k] = to->vertices + p->origin[loop[k]];
            to->material[to->triangles] = piece;
            c->facet[to->triangles++] = f;
        }
    for (uint32_t v = 0; v < p->vertex_count; v++)
        to->vertex[to->vertices++] = p->vertex[v];
}

static pir_status fill_surface(pir_solid_contacts *c, pir_polytope *const *piece, uint32_t pieces,
                               struct surface_arrays *a) {
    for (uint32_t i = 0; i < pieces; i++)
        add_piece(c, piece[i], i, a);
    const pir_trimesh_arrays arrays = {.vertices = a->vertex,
                                       .vertex_count = a->vertices,
                                       .triangles = a->corner,
                                       .triangle_count = a->triangles,
                                       .materials = a->material};
    pir_trimesh_options options = pir_trimesh_options_default();
    options.allocator = &c->allocator;
    return pir_trimesh_create(&arrays, &options, NULL, &c->surface);
}

static pir_status make_surface(pir_solid_contacts *c, pir_polytope *const *piece, uint32_t pieces) {
    const pir_allocator *a = &c->allocator;
    size_t vertices = 0, triangles = 0;
    for (uint32_t i = 0; i < pieces; i++) {
        vertices += piece[i]->vertex_count;
        triangles += piece[i]->half_count - 2 * (size_t)piece[i]->facet_count;
    }
    if (vertices > UINT32_MAX || triangles > UINT32_MAX / 4)
        return PIR_ERR_LIMIT;
    struct surface_arrays arrays = {PIR_NEW(a, pir_vec3, vertices), PIR_NEW(a, uint32_t, 3 * triangles),
                                    PIR_NEW(a, uint32_t, triangles), 0, 0};
    c->triangles = (uint32_t)triangles;
    c->facet = PIR_NEW(a, uint32_t, triangles);
    c->told = PIR_NEW(a, pir_surface_contact, OF_PIECE);
    const bool all = arrays.vertex && arrays.corner && arrays.material && c->facet && c->told;
    const pir_status status = all ? fill_surface(c, piece, pieces, &arrays) : PIR_ERR_MEMORY;
    PIR_FREE(a, arrays.vertex, vertices);
    PIR_FREE(a, arrays.corner, 3 * triangles);
    PIR_FREE(a, arrays.material, triangles);
    return status;
}

static pir_status take_surface(pir_solid_contacts *c, const pir_pieces *q) {
    const uint32_t pieces = pir_pieces_count(q);
    pir_polytope **piece = PIR_ZEROED(&c->allocator, pir_polytope *, pieces);
    if (!piece)
        return PIR_ERR_MEMORY;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < pieces && status == PIR_OK; i++)
        status = pir_pieces_polytope(q, i, &piece[i]);
    if (status == PIR_OK)
        status = make_surface(c, piece, pieces);
    for (uint32_t i = 0; i < pieces; i++)
        pir_polytope_release(piece[i]);
    PIR_FREE(&c->allocator, piece, pieces);
    return status;
}

pir_status pir_solid_contacts_create(const pir_pieces *p, const pir_pieces *q, const pir_allocator *allocator,
                                     pir_solid_contacts **ret_contacts) {
    if (!p || !q || !ret_contacts)
        return PIR_ERR_ARGUMENT;
    const pir_allocator a = pir_allocator_or_default(allocator);
    pir_solid_contacts *c = PIR_ZEROED(&a, pir_solid_contacts, 1);
    if (!c)
        return PIR_ERR_MEMORY;
    c->allocator = a;
    pir_status status = take_pieces(c, p);
    if (status == PIR_OK)
        status = take_surface(c, q);
    if (status == PIR_OK)
        status = pir_solid_query_create(p, q, &a, &c->query);
    if (status != PIR_OK) {
        pir_solid_contacts_destroy(c);
        return status;
    }
    *ret_contacts = c;
    return PIR_OK;
}

void pir_solid_contacts_destroy(pir_solid_contacts *contacts) {
    if (!contacts)
        return;
    pir_solid_contacts *c = contacts;
    const pir_allocator a = c->allocator;
    for (uint32_t i = 0; c->piece && i < c->pieces; i++)
        pir_polytope_release(c->piece[i]);
    PIR_FREE(&a, c->piece, c->pieces);
    pir_trimesh_release(c->surface);
    pir_solid_query_destroy(c->query);
    PIR_FREE(&a, c->facet, c->triangles);
    PIR_FREE(&a, c->told, OF_PIECE);
    PIR_FREE(&a, c->found, c->found_room);
    PIR_FREE(&a, c->mark, c->found_room);
    PIR_FREE(&a, c, 1);
}

/* --- what pieces tell --- */

/* Makes room for more contacts. */
static bool grow(pir_solid_contacts *c, size_t more) {
    if (c->count + more <= c->found_room)
        return true;
    const size_t room = 2 * (c->count + more);
    pir_solid_contact *found = PIR_NEW(&c->allocator, pir_solid_contact, room);
    enum contact_mark *mark = PIR_NEW(&c->allocator, enum contact_mark, room);
    if (!found || !mark) {
        PIR_FREE(&c->allocator, found, room);
        PIR_FREE(&c->allocator, mark, room);
        return false;
    }
    for (size_t i = 0; i < c->count; i++)
        found[i] = c->found[i];
    PIR_FREE(&c->allocator, c->found, c->found_room);
    PIR_FREE(&c->allocator, c->mark, c->found_room);
    c->found = found;
    c->mark = mark;
    c->found_room = room;
    return true;
}

/* The number of a contact of a piece among those of all pieces. */
static uint64_t id_of(uint32_t piece, uint64_t id) {
    uint64_t h = (id ^ (uint64_t)piece * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 29) * 0x94d049bb133111ebu;
    return h ^ h >> 32;
}

static pir_status ask_piece(pir_solid_contacts *c, pir_workspace *workspace, const pir_pair_input *input,
                            uint32_t piece) {
    const pir_posed_surface surface = {{c->surface, NULL}, input->pose_q};
    pir_surface_contact_input of = pir_surface_contact_input_default();
    pir_surface_contact_result result;
    of.pose = input->pose_p;
    of.radius = input->radius_p + input->radius_q;
    of.margin = input->margin;
    of.surfaces = &surface;
    of.surface_count = 1;
    of.beside = (const pir_polytope *const *)c->piece;
    of.beside_count = c->pieces;
    const pir_status status = pir_surface_contacts(c->piece[piece], workspace, &of, OF_PIECE, c->told, &result);
    if (status != PIR_OK)
        return status;
    if (!grow(c, result.contacts))
        return PIR_ERR_MEMORY;
    for (size_t i = 0; i < result.contacts; i++) {
        const pir_surface_contact *told = &c->told[i];
        c->found[c->count++] = (pir_solid_contact){.point_p = told->point_p,
                                                   .point_q = told->point_q,
                                                   .normal = told->normal,
                                                   .distance = told->distance,
                                                   .piece_p = piece,
                                                   .piece_q = told->material,
                                                   .facet_q = c->facet[told->triangle],
                                                   .id = id_of(piece, told->id)};
    }
    return PIR_OK;
}

/* The depth of the bodies as a contact, where they overlap. */
static pir_status ask_depth(pir_solid_contacts *c, pir_workspace *workspace, const pir_pair_input *input) {
    pir_solid_depth depth;
    const pir_status status = pir_solid_query_depth(c->query, workspace, input, &depth);
    if (status != PIR_OK || depth.state != PIR_INSIDE)
        return status;
    if (!grow(c, 1))
        return PIR_ERR_MEMORY;
    const pir_witness *of = &depth.facet[0].witness;
    const double distance = -depth.depth - input->radius_p - input->radius_q;
    c->found[c->count++] =
        (pir_solid_contact){.point_p = pir_vec_add(depth.point_q, pir_vec_scale(depth.normal, distance)),
                            .point_q = depth.point_q,
                            .normal = depth.normal,
                            .distance = distance,
                            .piece_p = depth.facet[0].piece_p,
                            .piece_q = depth.facet[0].piece_q,
                            .facet_q = of->q.kind == PIR_FEATURE_FACET ? of->q.index : UINT32_MAX,
                            .id = id_of(depth.facet[0].piece_p, (uint64_t)depth.facet[0].piece_q << 32)};
    return PIR_OK;
}

/* --- what is chosen --- */

static bool comes_before(const pir_solid_contact *a, const pir_solid_contact *b) {
    if (a->distance != b->distance)
        return a->distance < b->distance;
    return a->piece_p != b->piece_p ? a->piece_p < b->piece_p : a->id < b->id;
}

/* The deepest first: few, so by insertion. */
static void sort(pir_solid_contacts *c) {
    for (size_t i = 1; i < c->count; i++) {
        const pir_solid_contact x = c->found[i];
        size_t at = i;
        for (; at > 0 && comes_before(&x, &c->found[at - 1]); at--)
            c->found[at] = c->found[at - 1];
        c->found[at] = x;
    }
}

/* How much area a point adds to those that are chosen: the length from one, twice the area with two, or how far it is
 * beyond the sides of three. */
static double gain(const pir_solid_contact *const chosen[4], int count, const pir_solid_contact *x) {
    const pir_vec3 n = chosen[0]->normal, to = pir_vec_sub(x->point_q, chosen[0]->point_q);
    if (count == 1)
        return pir_vec_dot(to, to) - pir_vec_dot(to, n) * pir_vec_dot(to, n);
    if (count == 2)
        return fabs(pir_vec_dot(n, pir_vec_cross(pir_vec_sub(chosen[1]->point_q, chosen[0]->point_q), to)));
    const pir_vec3 a = chosen[0]->point_q, b = chosen[1]->point_q, d = chosen[2]->point_q;
    const double turn = pir_vec_dot(n, pir_vec_cross(pir_vec_sub(b, a), pir_vec_sub(d, a))) < 0 ? -1 : 1;
    const pir_vec3 corner[4] = {a, b, d, a};
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = fmax(most, -turn * pir_vec_dot(n, pir_vec_cross(pir_vec_sub(corner[k + 1], corner[k]),
                                                               pir_vec_sub(x->point_q, corner[k]))));
    return most;
}

static bool is_one_normal(pir_vec3 a, pir_vec3 b) {
    const pir_vec3 d = pir_vec_sub(a, b);
    return pir_vec_dot(d, d) <= ONE_NORMAL;
}

/* Chooses among the contacts of the normal of the one at `first`: that one, and three or fewer that add area. */
static size_t choose(pir_solid_contacts *c, size_t first, double nothing) {
    const pir_solid_contact *chosen[4] = {&c->found[first]};
    int count = 1;
    c->mark[first] = CONTACT_CHOSEN;
    for (size_t best = first; count < 4 && best < c->count; count += best < c->count) {
        double most = nothing;
        best = c->count;
        for (size_t i = first + 1; i < c->count; i++) {
            if (c->mark[i] == CONTACT_CHOSEN || !is_one_normal(c->found[i].normal, c->found[first].normal))
                continue;
            c->mark[i] = CONTACT_OF_NORMAL;
            const double more = gain(chosen, count, &c->found[i]);
            if (more > most) {
                most = more;
                best = i;
            }
        }
        if (best < c->count) {
            chosen[count] = &c->found[best];
            c->mark[best] = CONTACT_CHOSEN;
        }
    }
    return (size_t)count;
}

/* The square of how far apart contacts are. */
static double square_size(const pir_solid_contacts *c) {
    double size = 0;
    for (size_t i = 0; i < c->count; i++) {
        const pir_vec3 to = pir_vec_sub(c->found[i].point_q, c->found[0].point_q);
        size = fmax(size, pir_vec_dot(to, to));
    }
    return size;
}

pir_status pir_solid_contacts_find(pir_solid_contacts *contacts, pir_workspace *workspace, const pir_pair_input *input,
                                   size_t most, pir_solid_contact *ret_contacts, size_t *ret_count) {
    pir_solid_contacts *c = contacts;
    if (!c || !workspace || !input || (most > 0 && !ret_contacts) || !ret_count)
        return PIR_ERR_ARGUMENT;
    c->count = 0;
    for (uint32_t piece = 0; piece < c->pieces; piece++) {
        const pir_status status = ask_piece(c, workspace, input, piece);
        if (status != PIR_OK)
            return status;
    }
    if (c->count == 0) {
        const pir_status status = ask_depth(c, workspace, input);
        if (status != PIR_OK)
            return status;
    }
    sort(c);
    const double nothing = square_size(c) * 0x1p-40;
    size_t count = 0, written = 0;
    for (size_t i = 0; i < c->count; i++)
        c->mark[i] = CONTACT_NEW;
    for (size_t i = 0; i < c->count; i++)
        if (c->mark[i] == CONTACT_NEW)
            count += choose(c, i, nothing);
    for (size_t i = 0; i < c->count && written < most; i++)
        if (c->mark[i] == CONTACT_CHOSEN)
            ret_contacts[written++] = c->found[i];
    *ret_count = count;
    return PIR_OK;
}
