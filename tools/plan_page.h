/* SPDX-License-Identifier: MIT */
/*
 * A plan as one page of HTML that needs nothing else: the robot on its path between the obstacles, or, of a proof that
 * there is none, for each region of rotations the translations on the start's side and on the other one. Functions that
 * return false have complained.
 */
#ifndef TOOLS_PLAN_PAGE_H
#define TOOLS_PLAN_PAGE_H

#include <stdbool.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

struct plan_page {
    const char *title, *about;
    const pir_solid *const *solid; /* the robot's first */
    size_t count, of_robot;
    pir_pose end[2];
    pir_pose *pose; /* of a path: each a translation or a turn on the spot away from the one before */
    size_t poses, room;
    FILE *proof; /* that there is no path, as -o writes it; or NULL */
};

bool plan_page_add(struct plan_page *page, pir_pose pose);

/* Whether what was written arrived is the caller's to see. The proof is read from its beginning on. */
bool plan_page_write(FILE *file, const struct plan_page *page);

/* Frees the poses. */
void plan_page_clear(struct plan_page *page);

#endif
