/* SPDX-License-Identifier: MIT */
/*
 * Signs at roots, and first roots.
 *
 * A form is A + B cos 2φ + C sin 2φ with A = (c0 + c2)/2, B = (c0 − c2)/2, C = c1/2, of amplitude R = √(B² +
 * C²). Its exit root is where it turns positive, at 2φ = atan2(C, B) − acos(−A/R) with the slope 2√(R² −
 * A²) in φ. With coefficients off by ε values are off by 1.5ε, for σ² + |στ| + τ² is at most that, and by
 * ε/8 of rounding. The root is within δ = 4ε/slope where 2Rδ² is below ε: a form changes by 4ε − ε at least
 * within δ.
 *
 * A form is negative on an arc from a to b below π when it is at both ends and, with the polar form g(a, b),
 * −g(a, b) + √(g(a)·g(b)) > 0.
 */
#include "impact/search.h"

#include <float.h>

#include "impact/screw.h"

#define PI 3.14159265358979323846

/* φ from its functions, and directions from φ, are within this. */
#define ANGLE_ERROR 0x1p-49

static double value_at(const pir_course_form *form, double s, double t) {
    return form->c[0] * s * s + form->c[1] * s * t + form->c[2] * t * t;
}

static double cubic_at(const pir_course_form *form, double s, double t) {
    return s * value_at(form, s, t) + form->c[3] * t * t * t;
}

static double size_of(const pir_course_form *form) {
    return fabs(form->c[0]) + fabs(form->c[1]) + fabs(form->c[2]) + fabs(form->c[3]);
}

/* --- signs --- */

int pir_search_form_sign(const pir_impact_search *search, const pir_course_form *form) {
    const double value = (search->course.screws ? cubic_at : value_at)(form, search->sigma, search->tau);
    const double error = 3 * form->bound + 4 * size_of(form) * (search->now.slack + ANGLE_ERROR);
    return value > error ? 1 : value < -error ? -1 : 2;
}

int pir_search_filter(const pir_impact_search *search, const pir_condition *on) {
    const pir_course_form form = pir_course_form_of(&search->course, on);
    return pir_search_form_sign(search, &form);
}

static bool make_integers(pir_impact_search *search) {
    if (search->status == PIR_OK)
        search->status = pir_course_integers_make(&search->course);
    return search->status == PIR_OK;
}

/* The quadratic that now is a root of. */
static pir_quadratic root_of_now(pir_impact_search *search) {
    pir_course *course = &search->course;
    if (!search->has_root)
        pir_course_exact(course, &search->now.root, course->exact.root);
    search->has_root = true;
    return pir_course_view(course->exact.root);
}

int pir_search_sign(pir_impact_search *search, const pir_condition *on, pir_sign_when when) {
    int sign = pir_search_filter(search, on);
    if (sign != 2)
        return sign;
    if (!make_integers(search))
        return 1;
    pir_course *course = &search->course;
    if (course->screws)
        return pir_screw_sign(search, on, when);
    pir_course_exact(course, on, course->exact.other);
    const pir_quadratic view = pir_course_view(course->exact.other);
    if (search->now.kind != PIR_MOMENT_FIRST) {
        const pir_quadratic root = root_of_now(search);
        return pir_quadratic_sign_at(&view, &root, &course->exact.scratch);
    }
    return when == PIR_SIGN_NOW ? pir_int_sign(&view.c[0]) : pir_quadratic_sign_first(&view);
}

/* --- planes --- */

uint32_t pir_plane_count(const pir_impact_search *search, const pir_condition *plane) {
    return plane->kind == PIR_EDGES ? 5 : search->course.body[plane->kind == PIR_P_PLANE]->vertex_count;
}

pir_condition pir_plane_condition(const pir_condition *plane, uint32_t i) {
    pir_condition on = *plane;
    if (plane->kind == PIR_Q_PLANE) {
        on.p = i;
    } else if (plane->kind == PIR_P_PLANE) {
        on.q = i;
    } else if (i < 4) {
        on.kind = PIR_CROSSING;
        on.corner = (uint8_t)i;
    }
    return on;
}

/* --- exits --- */

/* Whether a form is surely negative from now to an angle, at (x, y). */
static bool stays_negative(const pir_impact_search *search, const pir_course_form *form, double phi, double x,
                           double y) {
    if (phi - search->now.phi > 3)
        return false;
    const double error = 3 * form->bound + 4 * size_of(form) * (search->now.slack + ANGLE_ERROR);
    const double s = search->sigma, t = search->tau;
    const double a = -value_at(form, s, t) - error, b = -value_at(form, x, y) - error;
    if (!(a > 0 && b > 0))
        return false;
    const double polar = -(form->c[0] * s * x + 0.5 * form->c[1] * (s * y + t * x) + form->c[2] * t * y) - error;
    return polar > 0 || polar + sqrt(a * b) * (1 - 0x1p-50) > 0;
}

/* 1 and the exit root where there surely is one after now, 0 where surely none, −1 where doubles cannot tell. */
static int exit_by_filter(const pir_impact_search *search, const pir_course_form *form, pir_moment *moment) {
    const double a = 0.5 * (form->c[0] + form->c[2]), b = 0.5 * (form->c[0] - form->c[2]), c = 0.5 * form->c[1];
    const double r = sqrt(b * b + c * c), d = (r - a) * (r + a);
    if (a + r < -8 * form->bound)
        return 0;
    if (!(d > 0))
        return -1;
    const double slope = 2 * sqrt(d), slack = 4 * form->bound / slope + ANGLE_ERROR;
    if (!(2 * r * slack * slack < form->bound))
        return -1;
    double phi = 0.5 * (atan2(c, b) - acos(fmin(1, fmax(-1, -a / r))));
    phi -= PI * floor(phi / PI);
    if (phi < slack || phi > PI - slack || fabs(phi - search->now.phi) <= slack + search->now.slack)
        return -1;
    moment->phi = phi;
    moment->slack = slack;
    return phi > search->now.phi;
}

/* The end as a quadratic. */
static pir_quadratic end_quadratic(pir_impact_search *search) {
    pir_course_integers *exact = &search->course.exact;
    pir_quadratic end = pir_quadratic_take(&exact->scratch, exact->double_limbs);
    pir_quadratic_of_double(&end, search->course.end_kappa, exact->exponent);
    return end;
}

/* φ of the exit root of a quadratic: κ is within 2^-48 of itself, φ therefore too. */
static double phi_of(const pir_course *course, const pir_quadratic *root, pir_limbs *scratch) {
    pir_scaled sigma, tau;
    pir_quadratic_approximate(root, &sigma, &tau, scratch);
    const double length = course->turns ? pir_vec_length(course->axis) : 1;
    int exponent;
    const double part = frexp(length, &exponent);
    const double x = ldexp(sigma.m / tau.m / part, sigma.e - tau.e + course->exact.exponent - exponent);
    return atan2(1, x);
}

/* Whether a condition's exit root comes after now and before the best so far, which is then set to it. */
static void exit_exactly(pir_impact_search *search, const pir_moment *at, pir_moment *best) {
    if (!make_integers(search))
        return;
    pir_course *course = &search->course;
    pir_limbs *scratch = &course->exact.scratch;
    pir_course_exact(course, &at->root, course->exact.other);
    const pir_quadratic view = pir_course_view(course->exact.other);
    if (!pir_quadratic_has_exit(&view, scratch))
        return;
    if (search->now.kind == PIR_MOMENT_ROOT) {
        const pir_quadratic root = root_of_now(search);
        if (pir_quadratic_compare(&view, &root, scratch) >= 0)
            return;
    }
    int order = 1;
    const uint32_t mark = scratch->used;
    if (best->kind == PIR_MOMENT_ROOT) {
        if (!course->exact.has_best)
            pir_course_exact(course, &best->root, course->exact.best);
        course->exact.has_best = true;
        const pir_quadratic other = pir_course_view(course->exact.best);
        order = pir_quadratic_compare(&view, &other, scratch);
    } else if (isfinite(search->course.end_kappa)) {
        const pir_quadratic other = end_quadratic(search);
        order = pir_quadratic_compare(&view, &other, scratch) >= 0;
    }
    scratch->used = mark;
    if (order > 0) {
        *best = *at;
        best->phi = phi_of(course, &view, scratch);
        best->slack = 0x1p-46;
        for (int k = 0; k < 3; k++)
            mpz_swap(course->exact.best[k], course->exact.other[k]);
        course->exact.has_best = true;
    }
}

/* Sets the best so far to a condition's exit root where that comes before it. */
static void take_exit(pir_impact_search *search, const pir_course_form *form, const pir_condition *on,
                      pir_moment *best) {
    pir_moment at = {.kind = PIR_MOMENT_ROOT, .root = *on};
    const int found = exit_by_filter(search, form, &at);
    if (found == 0 || (found == 1 && at.phi - at.slack > best->phi + best->slack))
        return;
    if (found == 1 && at.phi + at.slack < best->phi - best->slack) {
        *best = at;
        search->course.exact.has_best = false;
    } else {
        exit_exactly(search, &at, best);
    }
}

pir_moment pir_search_exit(pir_impact_search *search, const pir_condition *plane) {
    pir_moment best = search->end;
    search->course.exact.has_best = false;
    const uint32_t count = pir_plane_count(search, plane);
    const bool is_facet = plane->kind != PIR_EDGES;
    const pir_plane_rows rows = is_facet ? pir_course_rows(&search->course, plane) : (pir_plane_rows){0};
    double until = -1, x = 0, y = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double phi = fmin(PI, best.phi + best.slack);
        if (phi != until) {
            until = phi;
            x = cos(phi);
            y = sin(phi);
        }
        const pir_condition on = pir_plane_condition(plane, i);
        const pir_course_form form = is_facet ? pir_rows_form(&rows, i) : pir_course_form_of(&search->course, &on);
        if (search->course.screws)
            pir_screw_take_exit(search, &form, &on, &best);
        else if (!stays_negative(search, &form, phi, x, y))
            take_exit(search, &form, &on, &best);
    }
    return best;
}

void pir_search_go_to(pir_impact_search *search, pir_moment moment) {
    search->now = moment;
    search->sigma = cos(moment.phi);
    search->tau = sin(moment.phi);
    search->has_root = false;
}

void pir_search_refine(pir_impact_search *search) {
    if (search->now.slack <= 0x1p-33 * fmin(1, search->end.phi) || !make_integers(search))
        return;
    if (search->course.screws) {
        pir_screw_refine(search);
        return;
    }
    const pir_quadratic root = root_of_now(search);
    search->now.phi = phi_of(&search->course, &root, &search->course.exact.scratch);
    search->now.slack = 0x1p-46 * fmin(1, search->now.phi);
}

/* --- κ --- */

void pir_search_kappa(pir_impact_search *search, double ret_kappa[2]) {
    pir_course *course = &search->course;
    const double length = course->turns ? pir_vec_length(course->axis) : 1;
    const double slack = search->now.slack + ANGLE_ERROR;
    for (int k = 0; k < 2; k++) {
        const double phi = search->now.phi + (k == 0 ? slack : -slack);
        const double kappa = phi <= 0 ? INFINITY : phi >= PI ? -INFINITY : length / tan(phi);
        ret_kappa[k] = kappa + (k == 0 ? -1 : 1) * fabs(kappa) * 0x1p-50;
    }
}
