/* SPDX-License-Identifier: MIT */
/* Models by file or by name. */
#include "model.h"

#include <stdlib.h>
#include <string.h>

#include "input.h"
#include "message.h"

static const char *shape_of(const char *model) {
    size_t length = strlen(MODEL_SHAPE);
    return strncmp(model, MODEL_SHAPE, length) == 0 ? model + length : NULL;
}

/* OFF from standard input. */
static pir_polytope *load_stdin(void) {
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    size_t size;
    char *text = input_take() ? input_read(&size) : NULL;
    if (!text)
        return NULL;
    pir_status status = pir_polytope_read_off(text, size, INPUT_NAME, NULL, &report, &polytope);
    if (status != PIR_OK)
        complain_status(INPUT_NAME, status, &report);
    free(text);
    return polytope;
}

pir_polytope *model_load(const char *model) {
    if (input_is_stdin(model))
        return load_stdin();
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    const char *shape = shape_of(model);
    pir_status status =
        shape ? pir_shape_create(shape, NULL, &report, &polytope) : pir_polytope_read(model, NULL, &report, &polytope);
    if (status != PIR_OK)
        complain_status(model, status, &report);
    return status == PIR_OK ? polytope : NULL;
}

const char *model_title(const char *model) {
    const char *slash = shape_of(model) ? NULL : strrchr(model, '/');
    return slash ? slash + 1 : model;
}
