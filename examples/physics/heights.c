/* SPDX-License-Identifier: MIT */
/* Heights from files: see heights.h. A picture is read row by row, so that its size is known before its memory. */
#include "heights.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#if PHYSICS_HAVE_PNG
#include <png.h>
#endif

/* What a height field takes. */
#define SIDE_MOST 32768u
/* The longest line of a table. */
#define LINE_MOST ((size_t)1 << 20)
#define BLANKS    " \t\r\n"

bool heights_reserve(struct heights *heights, uint32_t columns, uint32_t rows) {
    double *at = realloc(heights->at, ((size_t)columns * rows + 1) * sizeof *at);
    if (!at)
        return false;
    heights->at = at;
    return true;
}

void heights_clear(struct heights *heights) {
    free(heights->at);
    *heights = (struct heights){0};
}

/* --- tables --- */

struct table {
    struct heights heights;
    uint32_t room; /* rows */
    unsigned line; /* of the file, from 1 */
    char *text, *why;
};

static bool fail(const struct table *table, const char *what, unsigned number) {
    snprintf(table->why, HEIGHTS_WHY, "line %u: %s %u", table->line, what, number);
    return false;
}

/*
 * The number at *text, which goes on behind it and what keeps numbers apart: blanks, among them at most one comma or
 * semicolon, behind which a number has to follow. So no field that is empty moves those after it.
 */
static bool take_number(struct table *table, char **text, unsigned column, double *ret_number) {
    char *end = *text;
    *ret_number = strtod(*text, &end);
    if (end == *text && (!*end || strchr(",;", *end)))
        return fail(table, "nothing in column", column);
    if (end == *text || (*end && !strchr(" \t,;\r\n", *end)))
        return fail(table, "no number in column", column);
    if (isinf(*ret_number))
        return fail(table, "no finite number in column", column);
    *text = end + strspn(end, BLANKS);
    if (**text != ',' && **text != ';')
        return true;
    *text += 1 + strspn(*text + 1, BLANKS);
    return **text || fail(table, "nothing in column", column + 1);
}

/* Adds the row of a line; the first says how many columns there are. */
static bool take_row(struct table *table) {
    struct heights *to = &table->heights;
    char *text = table->text + strspn(table->text, BLANKS);
    if (!*text || *text == '#')
        return true;
    if (to->rows == SIDE_MOST)
        return fail(table, "more rows than", SIDE_MOST);
    uint32_t count = 0;
    for (; *text; count++) {
        double number;
        if (!take_number(table, &text, count + 1, &number))
            return false;
        if (to->rows > 0 ? count == to->columns : count == SIDE_MOST)
            return fail(table, "more columns than", to->rows > 0 ? to->columns : SIDE_MOST);
        const size_t at = (size_t)to->rows * to->columns + count;
        if (to->rows == 0 && count % 256 == 0 && !heights_reserve(to, count + 256, 1))
            return fail(table, "out of memory in column", count + 1);
        to->at[at] = number;
    }
    if (to->rows > 0 && count < to->columns)
        return fail(table, "fewer columns than", to->columns);
    to->columns = count;
    to->rows++;
    if (to->rows >= table->room) {
        table->room = 2 * to->rows + 16;
        if (!heights_reserve(to, to->columns, table->room + 1))
            return fail(table, "out of memory in row", to->rows);
    }
    return true;
}

/* Reads a line into table->text; false after its last one, or with *good false where it is none. */
static bool take_line(struct table *table, FILE *file, bool *good) {
    size_t used = 0;
    int c = getc(file);
    if (c == EOF)
        return false;
    table->line++;
    for (; c != EOF && *good; c = c == '\n' ? EOF : getc(file)) {
        if (c == 0)
            *good = fail(table, "no text, has a zero in byte", (unsigned)used + 1);
        else if (used + 1 == LINE_MOST)
            *good = fail(table, "longer than bytes:", (unsigned)LINE_MOST);
        else
            table->text[used++] = (char)c;
    }
    table->text[used] = '\0';
    return *good;
}

bool heights_read_table(FILE *file, struct heights *ret_heights, char why[HEIGHTS_WHY]) {
    struct table table = {.text = malloc(LINE_MOST), .why = why};
    bool good = table.text;
    if (!good)
        snprintf(why, HEIGHTS_WHY, "out of memory");
    while (good && take_line(&table, file, &good))
        good = take_row(&table);
    if (good && ferror(file)) {
        snprintf(why, HEIGHTS_WHY, "cannot be read: %s", strerror(errno));
        good = false;
    } else if (good && table.heights.rows == 0) {
        snprintf(why, HEIGHTS_WHY, table.line == 0 ? "is empty" : "has no row of numbers");
        good = false;
    }
    free(table.text);
    if (good)
        *ret_heights = table.heights;
    else
        heights_clear(&table.heights);
    return good;
}

/* --- pictures --- */

#if PHYSICS_HAVE_PNG

struct picture {
    png_structp png;
    png_infop info;
    struct heights heights;
    png_bytep row;
    char *why;
};

static void on_error(png_structp png, png_const_charp message) {
    struct picture *picture = png_get_error_ptr(png);
    snprintf(picture->why, HEIGHTS_WHY, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

/* Has every kind of picture come as grey of 16 bits, without what is transparent. */
static void set_grey(struct picture *picture) {
    png_structp png = picture->png;
    const png_byte colour = png_get_color_type(png, picture->info);
    png_set_expand_16(png);
    png_set_strip_alpha(png);
    if (colour & PNG_COLOR_MASK_COLOR || colour == PNG_COLOR_TYPE_PALETTE)
        png_set_rgb_to_gray_fixed(png, PNG_ERROR_ACTION_NONE, PNG_RGB_TO_GRAY_DEFAULT, PNG_RGB_TO_GRAY_DEFAULT);
}

/* Reads all of it; errors end in a jump. */
static void read_picture(struct picture *picture) {
    struct heights *to = &picture->heights;
    png_read_info(picture->png, picture->info);
    to->columns = png_get_image_width(picture->png, picture->info);
    to->rows = png_get_image_height(picture->png, picture->info);
    if (to->columns > SIDE_MOST || to->rows > SIDE_MOST)
        png_error(picture->png, "more than 32768 pixels a side");
    if (png_get_interlace_type(picture->png, picture->info) != PNG_INTERLACE_NONE)
        png_error(picture->png, "interlaced pictures are not taken");
    set_grey(picture);
    png_read_update_info(picture->png, picture->info);
    picture->row = malloc(png_get_rowbytes(picture->png, picture->info));
    if (!picture->row || !heights_reserve(to, to->columns, to->rows))
        png_error(picture->png, "out of memory");
    for (uint32_t j = 0; j < to->rows; j++) {
        png_read_row(picture->png, picture->row, NULL);
        for (uint32_t i = 0; i < to->columns; i++) {
            const png_bytep pixel = picture->row + 2 * (size_t)i;
            to->at[(size_t)j * to->columns + i] = (256. * pixel[0] + pixel[1]) / 65535;
        }
    }
    png_read_end(picture->png, NULL);
}

bool heights_read_png(FILE *file, struct heights *ret_heights, char why[HEIGHTS_WHY]) {
    struct picture *picture = calloc(1, sizeof *picture);
    if (!picture)
        return false;
    picture->why = why;
    snprintf(why, HEIGHTS_WHY, "out of memory");
    picture->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, picture, on_error, on_warning);
    picture->info = picture->png ? png_create_info_struct(picture->png) : NULL;
    bool good = picture->info;
    if (good && setjmp(png_jmpbuf(picture->png)) == 0) {
        png_init_io(picture->png, file);
        read_picture(picture);
        *ret_heights = picture->heights;
        picture->heights = (struct heights){0};
    } else {
        good = false;
    }
    png_destroy_read_struct(&picture->png, &picture->info, NULL);
    free(picture->row);
    heights_clear(&picture->heights);
    free(picture);
    return good;
}

#else

bool heights_read_png(FILE *file, struct heights *ret_heights, char why[HEIGHTS_WHY]) {
    (void)file;
    (void)ret_heights;
    snprintf(why, HEIGHTS_WHY, "is a PNG, and this build was made without libpng (-Dpng=enabled)");
    return false;
}

#endif
