/* SPDX-License-Identifier: MIT */
/* The program that has what this one has not. */
#ifndef TOOLS_HAND_OVER_H
#define TOOLS_HAND_OVER_H

/*
 * Becomes `pirouette-slices` with the arguments, which end with NULL. It lies beside this program, as where both were
 * built, or in the folder for such programs of the installation. Returns only where it cannot be run: EXIT_BAD_INPUT
 * after a complaint.
 */
int hand_over(char *const *argv);

#endif
