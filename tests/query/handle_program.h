/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a program that makes, changes, uses and destroys objects in any order: bodies, sums, clones, sums
 * restored from bytes, queries, live meshes, cubical maps and their locators. A model beside them knows what each
 * answer must be: that of new objects, made for the purpose of bodies at the scale, rotation and region that the model
 * tells.
 */
#ifndef PIR_TEST_HANDLE_PROGRAM_H
#define PIR_TEST_HANDLE_PROGRAM_H

#include <stddef.h>
#include <stdint.h>

/*
 * Runs the program. NULL when all was as it must be; else what was not, and *ret_step says in which of its steps, from
 * 0.
 */
const char *handle_program_run(const uint8_t *data, size_t size, uint32_t *ret_step);

#endif
