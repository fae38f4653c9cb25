/* SPDX-License-Identifier: MIT */
/* The names in a file of slices, as docs/slices.md lists them, for writer and reader. */
#ifndef PIR_CSPACE_STORE_NAMES_H
#define PIR_CSPACE_STORE_NAMES_H

#define PIR_SLICES_FORMAT "pirouette slices"

/* A section: its group, and in it the elements, the elements of each slice, where units begin, their checks. */
typedef struct pir_unit_section_names {
    const char *group, *data, *count, *unit, *check;
} pir_unit_section_names;

static const pir_unit_section_names pir_names_of_section[] = {
    {"slices", "bytes", "length", "unit", "check"},
    {"planes", "plane", "count", "unit", "check"},
    {"vertices", "vertex", "count", "unit", "check"},
};

/* By pir_grid_kind. */
static const char *const pir_names_of_grid[] = {"axis", "hopf", "list"};

#endif
