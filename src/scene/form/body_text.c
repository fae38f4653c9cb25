/* SPDX-License-Identifier: MIT */
/* A body of a scene in words. */
#include <stdio.h>

#include <pirouette/body_shape.h>

pir_status pir_scene_body_text(const pir_scene *scene, uint32_t body, size_t size, char *text) {
    static const char *const kinds[3] = {"moving", "kinematic", "static"};
    pir_body_state state;
    const pir_status status = text && size > 0 ? pir_scene_get_body(scene, body, &state) : PIR_ERR_ARGUMENT;
    char of[32];
    if (status != PIR_OK)
        return status;
    if (state.piece_count > 0)
        snprintf(of, sizeof of, "%u %s", (unsigned)state.piece_count, state.piece_count == 1 ? "piece" : "pieces");
    else
        snprintf(of, sizeof of, "%s", state.mesh ? "a mesh" : "a height field");
    const pir_vec3 t = state.pose.translation;
    snprintf(text, size, "body %u, number %u: %s, %s, radius %g, at (%.6g, %.6g, %.6g), category %x, mask %x%s%s",
             (unsigned)body, (unsigned)pir_body_number(body), kinds[state.kind], of, state.radius, t.x, t.y, t.z,
             (unsigned)state.category, (unsigned)state.mask, state.sensor ? ", sensor" : "",
             state.disabled ? ", disabled" : "");
    return PIR_OK;
}
