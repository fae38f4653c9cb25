/* SPDX-License-Identifier: MIT */
/*
 * Turns as quaternions. With h half the angle, q ~ (axis, |axis|·cot h). For the angles that matter cot² h is 0, 1/3,
 * 1 or 3, so |axis|·cot h is one square root, which is exact when its argument is a square. Other angles take
 * (axis·sin h, |axis|·cos h), with h brought into the first octant by exact steps.
 */
#include "turn.h"

#include <math.h>
#include <stdbool.h>

#define PI 3.14159265358979323846

/* Largest and smallest binary exponents for which squares and products stay far from the ends of the range. */
#define EXPONENT_MOST 200

/* The axis, brought near 1 by a power of two when its squares could leave the range. */
static pir_vec3 tame(pir_vec3 axis) {
    int exponent;
    frexp(fmax(fabs(axis.x), fmax(fabs(axis.y), fabs(axis.z))), &exponent);
    if (exponent < EXPONENT_MOST && exponent > -EXPONENT_MOST)
        return axis;
    return (pir_vec3){ldexp(axis.x, -exponent), ldexp(axis.y, -exponent), ldexp(axis.z, -exponent)};
}

/* Any other angle: h = π·part/whole, between 0 and π/2. */
static pir_quat turn_by_sines(pir_vec3 axis, double length, double part, double whole) {
    double s, c;
    if (4 * part > whole) {
        double rest = PI * (whole - 2 * part) / (2 * whole);
        s = cos(rest);
        c = sin(rest);
    } else {
        s = sin(PI * part / whole);
        c = cos(PI * part / whole);
    }
    return (pir_quat){axis.x * s, axis.y * s, axis.z * s, length * c};
}

pir_quat turn_about(pir_vec3 axis, double part, double whole) {
    // Reduce to at most half a turn one way or the other; fmod and the difference are exact.
    bool back = part < 0;
    part = fmod(fabs(part), whole);
    if (2 * part > whole) {
        part = whole - part;
        back = !back;
    }
    if (part == 0)
        return (pir_quat){0, 0, 0, 1};

    axis = tame(axis);
    double square = axis.x * axis.x + axis.y * axis.y + axis.z * axis.z;
    pir_quat turn = {axis.x, axis.y, axis.z, 0};
    if (2 * part == whole)
        return turn;
    if (3 * part == whole)
        turn.w = sqrt(square / 3);
    else if (4 * part == whole)
        turn.w = sqrt(square);
    else if (6 * part == whole)
        turn.w = sqrt(square * 3);
    else
        turn = turn_by_sines(axis, sqrt(square), part, whole);
    if (back)
        turn.w = -turn.w;
    return turn;
}

pir_quat turn_after(pir_quat a, pir_quat b) {
    pir_quat q = {
        b.w * a.x + b.x * a.w + b.y * a.z - b.z * a.y,
        b.w * a.y - b.x * a.z + b.y * a.w + b.z * a.x,
        b.w * a.z + b.x * a.y - b.y * a.x + b.z * a.w,
        b.w * a.w - b.x * a.x - b.y * a.y - b.z * a.z,
    };
    double length = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return (pir_quat){q.x / length, q.y / length, q.z / length, q.w / length};
}
