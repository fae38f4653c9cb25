/* SPDX-License-Identifier: MIT */
/*
 * The objects of an OBJ text: what stands from a line `o NAME` to the next. Numbers of points count through the whole
 * file, so an object by itself has its points counted anew.
 */
#ifndef TOOLS_OBJECTS_H
#define TOOLS_OBJECTS_H

#include <stddef.h>

/* How many objects have facets. */
size_t objects_count(const char *text);

/*
 * The text of object `index` alone, with the points that its facets name; to be freed, NULL when out of memory. A facet
 * that names no point of the file stays as it is, for the reader of OBJ to complain of.
 */
char *objects_text(const char *text, size_t index);

/* The name of object `index` as its line `o` has it, or its number; to be freed, NULL when out of memory. */
char *objects_name(const char *text, size_t index);

#endif
