/* SPDX-License-Identifier: MIT */
/* Signs and first roots of cubics, which the conditions of a screw are; see search.h. */
#ifndef PIR_IMPACT_SCREW_H
#define PIR_IMPACT_SCREW_H

#include "impact/search.h"

/* The exact sign of a condition at the moment of now. Integers are made. */
int pir_screw_sign(pir_impact_search *search, const pir_condition *on, pir_sign_when when);

/* Sets the best so far to a condition's first root after now where that comes before it. */
void pir_screw_take_exit(pir_impact_search *search, const pir_course_form *form, const pir_condition *on,
                         pir_moment *best);

/* Makes the φ of now, a root, as good as doubles can be. Integers are made. */
void pir_screw_refine(pir_impact_search *search);

#endif
