/* SPDX-License-Identifier: MIT */
#include "planar.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../message.h"

bool planar_read(const struct args *args, struct planar *planar) {
    const char *value = args_value(args, "--planar");
    *planar = (struct planar){0};
    if (!value)
        return true;
    static const char axes[] = "xyz";
    const char *axis = *value ? strchr(axes, value[0]) : NULL;
    char *end = NULL;
    if (axis && value[1] == '=' && strspn(value + 2, "+-.0123456789eE") == strlen(value + 2))
        planar->offset = strtod(value + 2, &end);
    if (!end || end == value + 2 || *end || !isfinite(planar->offset)) {
        complain("--planar: '%s' is not x=NUMBER, y=NUMBER or z=NUMBER", value);
        return false;
    }
    planar->axis = (int)(axis - axes);
    planar->given = true;
    return true;
}

pir_section *planar_section(const struct planar *planar, const struct slices *slices, uint64_t shown, uint32_t pair) {
    pir_mesh *mesh = slices_mesh(slices, shown, pair, PIR_EXACT);
    pir_section *section = NULL;
    if (!mesh)
        return NULL;
    const pir_vec3 normal = {planar->axis == 0, planar->axis == 1, planar->axis == 2};
    pir_status status = pir_mesh_section(mesh, normal, planar->offset, &section);
    if (status != PIR_OK)
        complain_status(slices->path, status, NULL);
    pir_mesh_destroy(mesh);
    return section;
}

void planar_flat(const struct planar *planar, pir_vec3 corner, double ret_flat[2]) {
    const double c[3] = {corner.x, corner.y, corner.z};
    ret_flat[0] = c[(planar->axis + 1) % 3];
    ret_flat[1] = c[(planar->axis + 2) % 3];
}
