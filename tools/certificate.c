/* SPDX-License-Identifier: MIT */
/* Certificates to files. */
#include "certificate.h"

#include "file.h"
#include "message.h"
#include "target.h"

#define OPTION "--certificate"

bool certificate_check(const struct args *args, const char *const *others) {
    if (!args_has(args, OPTION))
        return true;
    for (; *others; others++)
        if (args_has(args, *others)) {
            complain("%s: there is no certificate with %s: leave out one of them", args->command->name, *others);
            return false;
        }
    return target_check(args, OPTION, NULL) && targets_differ(args, OPTION, "-o");
}

bool certificate_write(const struct args *args, pir_certificate *certificate) {
    struct output_file file = {0};
    size_t length;
    const char *text = pir_certificate_text(certificate, &length);
    bool done = output_open(&file, args_value(args, OPTION));
    if (done) {
        fwrite(text, 1, length, file.stream);
        done = output_commit(&file);
    }
    output_discard(&file);
    pir_certificate_destroy(certificate);
    return done;
}
