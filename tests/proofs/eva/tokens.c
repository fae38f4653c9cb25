/* SPDX-License-Identifier: MIT */
/* What Eva analyses: the tokens and numbers of polytope/read/text.h, of any BYTES bytes. */
#include "__fc_builtin.h"

#include "polytope/read/text.h"

#define BYTES 4

pir_status pir_fail(pir_report *report, pir_status status, const char *format, ...) {
    (void)report;
    (void)format;
    return status;
}

int main(void) {
    static struct pir_text text;
    char bytes[BYTES], shown[PIR_SHOWN];
    for (int i = 0; i < BYTES; i++)
        bytes[i] = (char)Frama_C_char_interval(-128, 127);
    pir_text_init(&text, bytes, BYTES, "file", 0);
    text.comments = Frama_C_interval(0, 1);
    text.folds = Frama_C_interval(0, 1);
    while (pir_text_next(&text, false)) {
        double value = 0;
        bool is_exact;
        mpq_t exact;
        uint64_t count;
        mpq_init(exact);
        const pir_status status = pir_text_exact_number(&text, 0, &value, &is_exact, exact);
        if (status == PIR_OK)
            text.folds = value > 0;
        if (pir_text_count(&text, &count) && pir_text_is(&text, "off") && pir_text_is_number(&text))
            pir_text_show(&text, shown);
        else
            pir_text_pass_line(&text);
    }
    return 0;
}
