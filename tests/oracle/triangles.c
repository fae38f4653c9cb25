/* SPDX-License-Identifier: MIT */
/* Triangles in rationals: see triangles.h. */
#include "oracle/triangles.h"

#include <stdlib.h>

void oracle_triangle_init(oracle_triangle *t) {
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            mpq_init(t->p[i][k]);
}

void oracle_triangle_clear(oracle_triangle *t) {
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            mpq_clear(t->p[i][k]);
}

void oracle_triangle_set(oracle_triangle *t, const pir_vec3 corner[3]) {
    for (int i = 0; i < 3; i++) {
        mpq_set_d(t->p[i][0], corner[i].x);
        mpq_set_d(t->p[i][1], corner[i].y);
        mpq_set_d(t->p[i][2], corner[i].z);
    }
}

/* sum += a·b·c, where c is an integer. */
static void add_product(mpq_t sum, mpq_t a, mpq_t b, int c) {
    mpq_t product, by;
    mpq_init(product);
    mpq_init(by);
    mpq_set_si(by, c, 1);
    mpq_mul(product, a, b);
    mpq_mul(product, product, by);
    mpq_add(sum, sum, product);
    mpq_clear(product);
    mpq_clear(by);
}

/* The matrix of a quaternion by its textbook entries, divided by the square of its length. */
static void rotation_of(pir_quat q, mpq_t m[3][3]) {
    mpq_t c[4], norm;
    const double v[4] = {q.x, q.y, q.z, q.w};
    for (int i = 0; i < 4; i++) {
        mpq_init(c[i]);
        mpq_set_d(c[i], v[i]);
    }
    mpq_init(norm);
    for (int i = 0; i < 4; i++)
        add_product(norm, c[i], c[i], 1);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = 3 - i - j;
            mpq_set_ui(m[i][j], 0, 1);
            if (i == j) {
                for (int l = 0; l < 4; l++)
                    add_product(m[i][j], c[l], c[l], l == i || l == 3 ? 1 : -1);
            } else {
                add_product(m[i][j], c[i], c[j], 2);
                add_product(m[i][j], c[k], c[3], (j - i + 3) % 3 == 1 ? -2 : 2);
            }
            mpq_div(m[i][j], m[i][j], norm);
        }
    for (int i = 0; i < 4; i++)
        mpq_clear(c[i]);
    mpq_clear(norm);
}

void oracle_triangle_place(oracle_triangle *t, const pir_vec3 corner[3], pir_pose pose) {
    oracle_triangle body;
    mpq_t m[3][3];
    oracle_triangle_init(&body);
    oracle_triangle_set(&body, corner);
    for (int i = 0; i < 9; i++)
        mpq_init(m[i / 3][i % 3]);
    rotation_of(pose.rotation, m);
    const double to[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            mpq_set_d(t->p[i][k], to[k]);
            for (int l = 0; l < 3; l++)
                add_product(t->p[i][k], m[k][l], body.p[i][l], 1);
        }
    for (int i = 0; i < 9; i++)
        mpq_clear(m[i / 3][i % 3]);
    oracle_triangle_clear(&body);
}

/* --- linear equations --- */

#define MOST 4

typedef struct equations {
    mpq_t at[MOST][MOST + 1]; /* rows of coefficients, and the right-hand side */
    int count;
} equations;

static void equations_init(equations *e, int count) {
    e->count = count;
    for (int i = 0; i < MOST; i++)
        for (int j = 0; j <= MOST; j++)
            mpq_init(e->at[i][j]);
}

static void equations_clear(equations *e) {
    for (int i = 0; i < MOST; i++)
        for (int j = 0; j <= MOST; j++)
            mpq_clear(e->at[i][j]);
}

/* Gauss and Jordan; false where the equations have not exactly one solution, which then is in the last column. */
static bool solve(equations *e) {
    int n = e->count;
    mpq_t by;
    mpq_init(by);
    bool regular = true;
    for (int c = 0; c < n && regular; c++) {
        int pivot = c;
        while (pivot < n && mpq_sgn(e->at[pivot][c]) == 0)
            pivot++;
        regular = pivot < n;
        if (!regular)
            break;
        for (int j = 0; j <= n; j++)
            mpq_swap(e->at[pivot][j], e->at[c][j]);
        for (int i = 0; i < n; i++) {
            if (i == c || mpq_sgn(e->at[i][c]) == 0)
                continue;
            mpq_div(by, e->at[i][c], e->at[c][c]);
            mpq_neg(by, by);
            for (int j = c; j <= n; j++)
                add_product(e->at[i][j], by, e->at[c][j], 1);
        }
    }
    for (int i = 0; i < n && regular; i++)
        mpq_div(e->at[i][n], e->at[i][n], e->at[i][i]);
    mpq_clear(by);
    return regular;
}

/* --- distances --- */

static void dot(mpq_t r, oracle_corner a, oracle_corner b) {
    mpq_set_ui(r, 0, 1);
    for (int k = 0; k < 3; k++)
        add_product(r, a[k], b[k], 1);
}

/* Room for what one pair of subsets needs. */
typedef struct subsets {
    oracle_corner side[MOST]; /* of x − y, moved by a weight */
    oracle_corner between;    /* x − y at the first corners */
    equations equations;
    int first; /* weights of these many sides belong to a, the rest to b */
    mpq_t sum, square;
} subsets;

static void make_sides(subsets *s, oracle_triangle *a, int in_a, oracle_triangle *b, int in_b) {
    int n = 0, from[2] = {-1, -1};
    for (int t = 0; t < 2; t++) {
        oracle_triangle *tri = t == 0 ? a : b;
        for (int i = 0; i < 3; i++) {
            if (!((t == 0 ? in_a : in_b) >> i & 1))
                continue;
            if (from[t] < 0) {
                from[t] = i;
                continue;
            }
            for (int k = 0; k < 3; k++) {
                mpq_sub(s->side[n][k], tri->p[i][k], tri->p[from[t]][k]);
                if (t == 1)
                    mpq_neg(s->side[n][k], s->side[n][k]);
            }
            n++;
        }
        if (t == 0)
            s->first = n;
    }
    for (int k = 0; k < 3; k++)
        mpq_sub(s->between[k], a->p[from[0]][k], b->p[from[1]][k]);
    s->equations.count = n;
}

/* Whether no weight of the solution is negative, those of the first corners among them. */
static bool weights_are_right(subsets *s) {
    int n = s->equations.count;
    for (int t = 0; t < 2; t++) {
        mpq_set_ui(s->sum, 1, 1);
        for (int i = t == 0 ? 0 : s->first; i < (t == 0 ? s->first : n); i++) {
            if (mpq_sgn(s->equations.at[i][n]) < 0)
                return false;
            mpq_sub(s->sum, s->sum, s->equations.at[i][n]);
        }
        if (mpq_sgn(s->sum) < 0)
            return false;
    }
    return true;
}

static bool subsets_distance(subsets *s, oracle_triangle *a, int in_a, oracle_triangle *b, int in_b) {
    make_sides(s, a, in_a, b, in_b);
    int n = s->equations.count;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            dot(s->equations.at[i][j], s->side[i], s->side[j]);
        dot(s->equations.at[i][n], s->side[i], s->between);
        mpq_neg(s->equations.at[i][n], s->equations.at[i][n]);
    }
    if (!solve(&s->equations) || !weights_are_right(s))
        return false;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < n; i++)
            add_product(s->between[k], s->equations.at[i][n], s->side[i][k], 1);
    dot(s->square, s->between, s->between);
    return true;
}

void oracle_triangles_least(mpq_t ret_square, oracle_triangle *a, oracle_triangle *b) {
    subsets s;
    equations_init(&s.equations, 0);
    for (int k = 0; k < 3; k++) {
        mpq_init(s.between[k]);
        for (int i = 0; i < MOST; i++)
            mpq_init(s.side[i][k]);
    }
    mpq_init(s.sum);
    mpq_init(s.square);
    bool any = false;
    for (int in_a = 1; in_a < 8; in_a++)
        for (int in_b = 1; in_b < 8; in_b++)
            if (subsets_distance(&s, a, in_a, b, in_b) && (!any || mpq_cmp(s.square, ret_square) < 0)) {
                mpq_set(ret_square, s.square);
                any = true;
            }
    mpq_clear(s.sum);
    mpq_clear(s.square);
    for (int k = 0; k < 3; k++) {
        mpq_clear(s.between[k]);
        for (int i = 0; i < MOST; i++)
            mpq_clear(s.side[i][k]);
    }
    equations_clear(&s.equations);
}

void oracle_triangles_most(mpq_t ret_square, oracle_triangle *a, oracle_triangle *b) {
    mpq_t square, difference;
    mpq_init(square);
    mpq_init(difference);
    mpq_set_ui(ret_square, 0, 1);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            mpq_set_ui(square, 0, 1);
            for (int k = 0; k < 3; k++) {
                mpq_sub(difference, a->p[i][k], b->p[j][k]);
                add_product(square, difference, difference, 1);
            }
            if (mpq_cmp(square, ret_square) > 0)
                mpq_set(ret_square, square);
        }
    mpq_clear(square);
    mpq_clear(difference);
}

/* --- segments --- */

bool oracle_segment_meets(oracle_triangle *t, pir_vec3 origin, pir_vec3 way, mpq_t ret_time, int *ret_side) {
    // origin + time·way = p0 + u·(p1 − p0) + v·(p2 − p0)
    equations e;
    equations_init(&e, 3);
    const double o[3] = {origin.x, origin.y, origin.z}, d[3] = {way.x, way.y, way.z};
    mpq_t det, term, sum;
    mpq_init(det);
    mpq_init(term);
    mpq_init(sum);
    oracle_corner side[2];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 2; i++) {
            mpq_init(side[i][k]);
            mpq_sub(side[i][k], t->p[i + 1][k], t->p[0][k]);
            mpq_neg(e.at[k][i + 1], side[i][k]);
        }
        mpq_set_d(e.at[k][0], d[k]);
        mpq_set_d(e.at[k][3], o[k]);
        mpq_sub(e.at[k][3], t->p[0][k], e.at[k][3]);
    }
    // the way along the normal
    for (int k = 0; k < 3; k++) {
        mpq_mul(sum, side[0][(k + 1) % 3], side[1][(k + 2) % 3]);
        mpq_mul(term, side[0][(k + 2) % 3], side[1][(k + 1) % 3]);
        mpq_sub(sum, sum, term);
        mpq_mul(sum, sum, e.at[k][0]);
        mpq_add(det, det, sum);
    }
    *ret_side = -mpq_sgn(det);
    bool meets = solve(&e);
    if (meets) {
        mpq_set(ret_time, e.at[0][3]);
        mpq_add(sum, e.at[1][3], e.at[2][3]);
        meets = mpq_sgn(ret_time) >= 0 && mpq_cmp_ui(ret_time, 1, 1) <= 0 && mpq_sgn(e.at[1][3]) >= 0 &&
                mpq_sgn(e.at[2][3]) >= 0 && mpq_cmp_ui(sum, 1, 1) <= 0;
    }
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++)
            mpq_clear(side[i][k]);
    mpq_clear(det);
    mpq_clear(term);
    mpq_clear(sum);
    equations_clear(&e);
    return meets;
}

/* --- boxes --- */

#define CORNERS 16

typedef struct polygon {
    oracle_corner at[CORNERS];
    int count;
} polygon;

/* Keeps what has sign·(x[axis] − bound) ≤ 0 (Sutherland and Hodgman). */
static void clip(polygon *from, polygon *to, int axis, double bound, int sign) {
    mpq_t level, a, b, part;
    mpq_init(level);
    mpq_init(a);
    mpq_init(b);
    mpq_init(part);
    mpq_set_d(level, bound);
    to->count = 0;
    for (int i = 0; i < from->count; i++) {
        oracle_corner *p = &from->at[i], *q = &from->at[(i + 1) % from->count];
        mpq_sub(a, (*p)[axis], level);
        mpq_sub(b, (*q)[axis], level);
        int sa = sign * mpq_sgn(a), sb = sign * mpq_sgn(b);
        if (sa <= 0) {
            for (int k = 0; k < 3; k++)
                mpq_set(to->at[to->count][k], (*p)[k]);
            to->count++;
        }
        if (sa * sb < 0) {
            mpq_sub(part, a, b);
            mpq_div(part, a, part);
            for (int k = 0; k < 3; k++) {
                mpq_sub(b, (*q)[k], (*p)[k]);
                mpq_set(to->at[to->count][k], (*p)[k]);
                add_product(to->at[to->count][k], part, b, 1);
            }
            to->count++;
        }
    }
    mpq_clear(level);
    mpq_clear(a);
    mpq_clear(b);
    mpq_clear(part);
}

bool oracle_box_meets(oracle_triangle *t, pir_vec3 low, pir_vec3 high) {
    polygon polygons[2];
    for (int i = 0; i < 2 * CORNERS; i++)
        for (int k = 0; k < 3; k++)
            mpq_init(polygons[i / CORNERS].at[i % CORNERS][k]);
    polygon *now = &polygons[0], *next = &polygons[1];
    now->count = 3;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            mpq_set(now->at[i][k], t->p[i][k]);
    const double bounds[2][3] = {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
    for (int side = 0; side < 6; side++) {
        clip(now, next, side % 3, bounds[side / 3][side % 3], side < 3 ? -1 : 1);
        polygon *swap = now;
        now = next;
        next = swap;
    }
    bool meets = now->count > 0;
    for (int i = 0; i < 2 * CORNERS; i++)
        for (int k = 0; k < 3; k++)
            mpq_clear(polygons[i / CORNERS].at[i % CORNERS][k]);
    return meets;
}
