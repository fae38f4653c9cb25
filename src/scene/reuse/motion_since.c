/* SPDX-License-Identifier: MIT */
/* Bodies seen from each other: see motion_since.h. */
#include "scene/reuse/motion_since.h"

/*
 * Unit quaternions of bodies are within 8u of the exact ones, u = 2^-53, so their product is within 24u. A matrix is
 * within 31u of the rotation of its quaternion, 47u of the exact one. The difference of translations is off by u of
 * both, and turning it by 6u more. So a translation is off by less than 60u of both lengths: below half of this.
 */
#define SEEN_ERROR 0x1p-46

pir_seen_side pir_seen_side_of(const pir_scene *scene, uint32_t pair) {
    double reach[2];
    for (int k = 0; k < 2; k++) {
        const pir_scene_piece *piece = &scene->bodies.piece[scene->pairs.at[pair].piece[k]];
        reach[k] = piece->extent.reach + scene->bodies.body[piece->body].radius;
    }
    const int side = reach[1] < reach[0] ? 1 : 0;
    return (pir_seen_side){side, reach[side]};
}

/* conj(a) · b */
static pir_quat relative(pir_quat a, pir_quat b) {
    return (pir_quat){a.w * b.x - a.x * b.w - a.y * b.z + a.z * b.y, a.w * b.y - a.y * b.w - a.z * b.x + a.x * b.z,
                      a.w * b.z - a.z * b.w - a.x * b.y + a.y * b.x, a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z};
}

pir_seen pir_see(const pir_scene *scene, uint32_t pair) {
    const pir_seen_side of_pair = pir_seen_side_of(scene, pair);
    const int side = of_pair.side;
    const uint32_t *of = scene->pairs.at[pair].piece;
    const pir_scene_body *seen = &scene->bodies.body[scene->bodies.piece[of[side]].body],
                         *from = &scene->bodies.body[scene->bodies.piece[of[1 - side]].body];
    const pir_vec3 s = seen->pose.translation, f = from->pose.translation;
    const pir_rotation_doubles turned = pir_doubles_as_given(from->unit);
    return (pir_seen){.rotation = relative(from->unit, seen->unit),
                      .translation = pir_mat_apply_transposed(&turned.r, pir_vec_sub(s, f)),
                      .error = SEEN_ERROR * (pir_vec_taxicab(s) + pir_vec_taxicab(f) + of_pair.reach)};
}
