/* SPDX-License-Identifier: MIT */
/*
 * A search along a course: the moment it has come to, signs there, and when a separating plane ceases to separate.
 *
 * A plane is that of a facet of the difference, a condition of the kinds PIR_Q_PLANE, PIR_P_PLANE (the vertex left
 * out) or PIR_EDGES. It separates strictly at a moment when all its conditions are negative there.
 *
 * Invariant: at all κ above the moment's the bodies share no point.
 */
#ifndef PIR_IMPACT_SEARCH_H
#define PIR_IMPACT_SEARCH_H

#include "impact/course.h"

/* A κ: the beginning, the end of the motion, or the exit root of a condition. φ is within `slack`. */
typedef struct pir_moment {
    enum { PIR_MOMENT_FIRST, PIR_MOMENT_END, PIR_MOMENT_ROOT } kind;
    double phi, slack;
    pir_condition root;
    int ordinal; /* of a screw, where not 0: the root is that one of its condition's after the beginning */
} pir_moment;

typedef struct pir_impact_search {
    pir_course course;
    pir_moment now, end;
    double sigma, tau; /* of now */
    bool has_root;     /* the integers `root`, or `cubic_root`, are now's */
    pir_status status;
    uint32_t planes;
} pir_impact_search;

/* How signs are meant: now; or, at the beginning, a hair after it. */
typedef enum pir_sign_when { PIR_SIGN_NOW, PIR_SIGN_SOON } pir_sign_when;

/* The sign of a condition; 2 where doubles alone do not tell. Failures are kept in `status`; the sign is then 1. */
int pir_search_filter(const pir_impact_search *search, const pir_condition *on);
int pir_search_form_sign(const pir_impact_search *search, const pir_course_form *form);
int pir_search_sign(pir_impact_search *search, const pir_condition *on, pir_sign_when when);

/* How many conditions a plane has, and one of them; those of edges that are no slacks come first. */
uint32_t pir_plane_count(const pir_impact_search *search, const pir_condition *plane);
pir_condition pir_plane_condition(const pir_condition *plane, uint32_t i);

/* When a plane that separates strictly now first ceases to: a root, or the end where it does not before. */
pir_moment pir_search_exit(pir_impact_search *search, const pir_condition *plane);

void pir_search_go_to(pir_impact_search *search, pir_moment moment);

/* Makes the slack of now, a root, at most 2^-33, and of a short motion at most 2^-33 of it. */
void pir_search_refine(pir_impact_search *search);

/* Doubles around now's κ, a root. */
void pir_search_kappa(pir_impact_search *search, double ret_kappa[2]);

#endif
