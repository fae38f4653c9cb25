/* SPDX-License-Identifier: MIT */
/*
 * Pictures of convex bodies as SVG.
 *
 * No facet of a convex body hides another that faces the viewer, so those that do are drawn in any order. The
 * view is orthographic from a fixed direction, z up, a little to the right of the x axis and above the horizon; a
 * facet's colour says its kind, its shade the angle of its normal to a light over the viewer's left shoulder. Floats
 * decide what faces the viewer: whether a facet seen from its edge is drawn changes no visible area.
 *
 * Bodies of any size and place are drawn alike: coordinates are taken relative to the centre of their bounds and to the
 * largest of them, which overflows nowhere.
 */
#include "polytope/write/write_svg.h"

#include <math.h>

#include <cglm/cglm.h>

#include "base/vec.h"
#include "polytope/file/c_locale.h"

/* The picture: the longer side of the body, the space around it, the space between it and the legend. */
#define PICTURE_SIZE   560.0
#define PICTURE_MARGIN 24.0
#define LEGEND_GAP     20.0

/* The view by columns: what x, y and z show to the right, up, and towards the viewer, at azimuth 35° from x
   to y and elevation 25°. */
#define VIEW                                                                                                           \
    {                                                                                                                  \
        {-0.57357644f, -0.34618861f, 0.74240388f}, {0.81915204f, -0.24240388f, 0.51983679f}, {                         \
            0, 0.90630779f, 0.42261826f                                                                                \
        }                                                                                                              \
    }

/* The way to the light, in that frame: left, up, towards the viewer. */
#define LIGHT                                                                                                          \
    { -0.4f, 0.67f, 0.625f }

/* One colour per kind of facet, in the order of pir_facet_kind, and its word in the legend. */
static const struct kind_style {
    double red, green, blue;
    const char *label;
    double label_width;
} kind_styles[4] = {
    {92, 138, 190, "facets of P", 66},
    {240, 165, 84, "facets of Q", 66},
    {98, 179, 162, "edge pairs", 60},
    {176, 122, 170, "merged", 44},
};

#define KIND_COUNT 4
#define SWATCH     14.0
#define ENTRY_GAP  22.0

/* A vertex of the body in the frame of the view, relative to its centre and radius. */
static void view_vertex(const struct pir_svg_body *body, uint32_t vertex, vec3 ret_seen) {
    mat3 view = VIEW;
    vec3 relative = GLM_VEC3_ZERO_INIT;
    if (body->radius != 0) {
        pir_vec3 d = pir_vec_sub(pir_mesh_vertices(body->mesh)[vertex], body->centre);
        relative[0] = (float)(d.x / body->radius);
        relative[1] = (float)(d.y / body->radius);
        relative[2] = (float)(d.z / body->radius);
    }
    glm_mat3_mulv(view, relative, ret_seen);
}

static void project(const struct pir_svg_body *body, uint32_t vertex, double ret_xy[2]) {
    vec3 seen;
    view_vertex(body, vertex, seen);
    ret_xy[0] = seen[0];
    ret_xy[1] = -seen[1];
}

/* The unit normal of a facet in the frame of the view (Newell's sum, about the first corner); zero for
   one too thin to have any. */
static void facet_normal(const struct pir_svg_body *body, const uint32_t *corners, uint32_t count, vec3 ret_normal) {
    vec3 origin, last, next, part;
    glm_vec3_zero(ret_normal);
    view_vertex(body, corners[0], origin);
    view_vertex(body, corners[1], last);
    glm_vec3_sub(last, origin, last);
    for (uint32_t i = 2; i < count; i++) {
        view_vertex(body, corners[i], next);
        glm_vec3_sub(next, origin, next);
        glm_vec3_cross(last, next, part);
        glm_vec3_add(ret_normal, part, ret_normal);
        glm_vec3_copy(next, last);
    }
    glm_vec3_normalize(ret_normal);
}

/* Whether a facet is drawn. A polygon has two sides and one of them always is: as a line when seen from its edge. */
static bool is_drawn(const struct pir_svg_body *body, uint32_t facet, vec3 normal) {
    return pir_mesh_facet_count(body->mesh) == 2 && facet == 0 ? normal[2] >= 0 : normal[2] > 0;
}

/* The bounds of a mesh's vertices. */
static void mesh_bounds(const pir_mesh *mesh, pir_vec3 *ret_low, pir_vec3 *ret_high) {
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    pir_vec3 low = vertices[0], high = vertices[0];
    for (uint32_t v = 1; v < pir_mesh_vertex_count(mesh); v++) {
        low.x = vertices[v].x < low.x ? vertices[v].x : low.x;
        low.y = vertices[v].y < low.y ? vertices[v].y : low.y;
        low.z = vertices[v].z < low.z ? vertices[v].z : low.z;
        high.x = vertices[v].x > high.x ? vertices[v].x : high.x;
        high.y = vertices[v].y > high.y ? vertices[v].y : high.y;
        high.z = vertices[v].z > high.z ? vertices[v].z : high.z;
    }
    *ret_low = low;
    *ret_high = high;
}

struct pir_svg_body pir_svg_measure(const pir_mesh *mesh) {
    struct pir_svg_body body = {.mesh = mesh};
    pir_vec3 low, high;
    mesh_bounds(mesh, &low, &high);
    body.centre = (pir_vec3){low.x / 2 + high.x / 2, low.y / 2 + high.y / 2, low.z / 2 + high.z / 2};
    body.radius = fmax(fmax(high.x - body.centre.x, high.y - body.centre.y), high.z - body.centre.z);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        double xy[2];
        project(&body, v, xy);
        for (int axis = 0; axis < 2; axis++) {
            body.low[axis] = v == 0 ? xy[axis] : fmin(body.low[axis], xy[axis]);
            body.high[axis] = v == 0 ? xy[axis] : fmax(body.high[axis], xy[axis]);
        }
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corners = pir_mesh_facet(mesh, f, &count);
        vec3 normal;
        facet_normal(&body, corners, count, normal);
        if (is_drawn(&body, f, normal))
            body.kinds |= 1u << pir_mesh_facet_kind(mesh, f);
    }
    return body;
}

/* One channel of a colour in the shade of a facet: darkened away from the light, whitened a
   little straight towards it. */
static int shade(double channel, double lit) {
    double dark = channel * (0.58 + 0.42 * lit), white = 0.22 * lit * lit * lit;
    return (int)lround(dark + (255 - dark) * white);
}

static void write_facet(FILE *file, const struct pir_svg_body *body, uint32_t facet, double x, double y, double scale) {
    uint32_t count;
    const uint32_t *corners = pir_mesh_facet(body->mesh, facet, &count);
    vec3 normal, light = LIGHT;
    facet_normal(body, corners, count, normal);
    if (!is_drawn(body, facet, normal))
        return;
    double lit = glm_clamp(0.5f + 0.5f * glm_vec3_dot(normal, light), 0, 1);
    const struct kind_style *style = &kind_styles[pir_mesh_facet_kind(body->mesh, facet)];
    fprintf(file, "<path fill=\"#%02x%02x%02x\" d=\"", (unsigned)shade(style->red, lit),
            (unsigned)shade(style->green, lit), (unsigned)shade(style->blue, lit));
    for (uint32_t i = 0; i < count; i++) {
        double xy[2];
        project(body, corners[i], xy);
        fprintf(file, "%s%.2f %.2f", i ? "L" : "M", x + scale * xy[0], y + scale * xy[1]);
    }
    fprintf(file, "Z\"/>\n");
}

/* A body without facets: a segment or a point. */
static void write_thin(FILE *file, const struct pir_svg_body *body, double x, double y, double scale) {
    double a[2], b[2];
    project(body, 0, a);
    project(body, pir_mesh_vertex_count(body->mesh) - 1, b);
    if (pir_mesh_vertex_count(body->mesh) > 1)
        fprintf(file, "<path stroke-width=\"2.5\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n", x + scale * a[0], y + scale * a[1],
                x + scale * b[0], y + scale * b[1]);
    else
        fprintf(file, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"4\" fill=\"#24384a\" stroke=\"none\"/>\n", x, y);
}

void pir_svg_write_body(FILE *file, const struct pir_svg_body *body, double x, double y, double scale) {
    struct pir_c_locale locale;
    bool entered = pir_c_locale_enter(&locale);
    uint32_t facets = pir_mesh_facet_count(body->mesh);
    // The more facets, the thinner their outlines.
    double stroke = 0.25 + 1.1 / (1.0 + sqrt(facets) / 30.0);
    fprintf(file, "<g stroke=\"#24384a\" stroke-width=\"%.2f\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n",
            stroke);
    for (uint32_t f = 0; f < facets; f++)
        write_facet(file, body, f, x, y, scale);
    if (facets == 0)
        write_thin(file, body, x, y, scale);
    fprintf(file, "</g>\n");
    if (entered)
        pir_c_locale_leave(&locale);
}

double pir_svg_legend_width(unsigned kinds) {
    double width = -ENTRY_GAP;
    for (int kind = 0; kind < KIND_COUNT; kind++)
        if (kinds & (1u << kind))
            width += SWATCH + 7 + kind_styles[kind].label_width + ENTRY_GAP;
    return width > 0 ? width : 0;
}

void pir_svg_write_legend(FILE *file, unsigned kinds, double x, double y) {
    fprintf(file, "<g font-family=\"Helvetica,Arial,sans-serif\" font-size=\"13\" fill=\"#24384a\">\n");
    double middle = y + PIR_SVG_LEGEND_HEIGHT / 2;
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        if (!(kinds & (1u << kind)))
            continue;
        const struct kind_style *style = &kind_styles[kind];
        fprintf(file,
                "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.0f\" height=\"%.0f\" rx=\"3\" fill=\"#%02x%02x%02x\" "
                "stroke=\"#24384a\" "
                "stroke-width=\"0.8\"/>\n",
                x, middle - SWATCH / 2, SWATCH, SWATCH, (unsigned)style->red, (unsigned)style->green,
                (unsigned)style->blue);
        fprintf(file, "<text x=\"%.2f\" y=\"%.2f\">%s</text>\n", x + SWATCH + 7, middle + 4.5, style->label);
        x += SWATCH + 7 + style->label_width + ENTRY_GAP;
    }
    fprintf(file, "</g>\n");
}

pir_status pir_mesh_write_svg(const pir_mesh *mesh, FILE *file) {
    struct pir_c_locale locale;
    if (!pir_c_locale_enter(&locale))
        return PIR_ERR_MEMORY;
    // The body's longer side fills the picture; a point has no size and sits in its middle.
    struct pir_svg_body body = pir_svg_measure(mesh);
    double extent[2] = {body.high[0] - body.low[0], body.high[1] - body.low[1]};
    double longer = fmax(extent[0], extent[1]);
    double scale = longer > 0 ? PICTURE_SIZE / longer : 0;

    // A legend only where it tells kinds apart; it may be wider than a slim body.
    bool legend = (body.kinds & (body.kinds - 1)) != 0;
    double legend_width = legend ? pir_svg_legend_width(body.kinds) : 0;
    double body_height = scale * extent[1];
    double width = fmax(scale * extent[0], legend_width) + 2 * PICTURE_MARGIN;
    double height = body_height + 2 * PICTURE_MARGIN + (legend ? LEGEND_GAP + PIR_SVG_LEGEND_HEIGHT : 0);

    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.2f %.2f\">\n",
            ceil(width), ceil(height), width, height);
    fprintf(file, "<title>Convex body: %u vertices, %u edges, %u facets</title>\n",
            (unsigned)pir_mesh_vertex_count(mesh), (unsigned)pir_mesh_edge_count(mesh),
            (unsigned)pir_mesh_facet_count(mesh));
    fprintf(file, "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n");
    double x = width / 2 - scale * (body.low[0] + body.high[0]) / 2;
    double y = PICTURE_MARGIN + body_height / 2 - scale * (body.low[1] + body.high[1]) / 2;
    pir_svg_write_body(file, &body, x, y, scale);
    if (legend)
        pir_svg_write_legend(file, body.kinds, (width - legend_width) / 2,
                             height - PICTURE_MARGIN - PIR_SVG_LEGEND_HEIGHT);
    fprintf(file, "</svg>\n");
    pir_c_locale_leave(&locale);
    return PIR_OK;
}
