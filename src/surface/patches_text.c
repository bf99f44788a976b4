/* Parser of patch sets. */
#include "surface/patches.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

#define POINTS_MAX (16 * WR_PATCHES_MAX)
#define SHOWN 24 /* maximum letters of a quoted word */

typedef struct Reader {
    const char *at, *end;
    int line;
} Reader;

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
}

static void skip_space(Reader *r)
{
    bool remark = false;
    for (; r->at < r->end; r->at++) {
        if (*r->at == '\n') r->line++, remark = false;
        else if (*r->at == '#') remark = true;
        else if (!remark && !is_space(*r->at)) return;
    }
}

/* The next word; length 0 at the end. */
static const char *next_word(Reader *r, size_t *length)
{
    skip_space(r);
    const char *from = r->at;
    while (r->at < r->end && !is_space(*r->at) && *r->at != '#') r->at++;
    *length = (size_t)(r->at - from);
    return from;
}

static bool bad_word(const Reader *r, const char *word, size_t length, const char *what,
                     WrError *err)
{
    const int shown = length < SHOWN ? (int)length : SHOWN;
    if (length == 0)
        return wr_fail(err, "line %d: the file ends where %s should stand", r->line, what);
    return wr_fail(err, "line %d: \"%.*s\" is not %s", r->line, shown, word, what);
}

static bool read_number(Reader *r, float *out, WrError *err)
{
    size_t length;
    double number;
    const char *word = next_word(r, &length);
    if (!wr_number_parse(word, length, &number) || !(fabs(number) <= 1e30))
        return bad_word(r, word, length, "a coordinate, a number within 1e30 of 0", err);
    *out = (float)number + 0.0f; /* -0 is 0 */
    return true;
}

static bool read_whole(Reader *r, int32_t low, int32_t high, const char *what, int32_t *out,
                       WrError *err)
{
    size_t length;
    double number;
    const char *word = next_word(r, &length);
    char told[120];
    snprintf(told, sizeof told, "%s, %d..%d", what, (int)low, (int)high);
    if (!wr_number_parse(word, length, &number) || !(number >= low && number <= high) ||
        number != floor(number))
        return bad_word(r, word, length, told, err);
    *out = (int32_t)number;
    return true;
}

static bool read_point(Reader *r, float *out, WrError *err)
{
    return read_number(r, out, err) && read_number(r, out + 1, err) && read_number(r, out + 2, err);
}

/* "3 3" and sixteen points each. */
static bool read_blocks(Reader *r, float (*points)[48], int32_t count, WrError *err)
{
    for (int32_t i = 0; i < count; i++) {
        char what[60];
        int32_t degree;
        snprintf(what, sizeof what, "a degree of patch %d", (int)i + 1);
        if (!read_whole(r, 3, 3, what, &degree, err) || !read_whole(r, 3, 3, what, &degree, err))
            return false;
        for (int k = 0; k < 16; k++)
            if (!read_point(r, points[i] + 3 * k, err)) return false;
    }
    return true;
}

/* Rows of sixteen indices, stored as floats in the points' memory until the points are known. */
static bool read_list(Reader *r, float (*points)[48], int32_t count, WrError *err)
{
    int32_t known, most = 0, number;
    for (int32_t i = 0; i < 16 * count; i++) {
        if (!read_whole(r, 1, POINTS_MAX, "the number of a point", &number, err)) return false;
        most = number > most ? number : most;
        points[i / 16][3 * (i % 16)] = (float)number;
    }
    if (!read_whole(r, 1, POINTS_MAX, "the count of points", &known, err)) return false;
    if (most > known)
        return wr_fail(err, "line %d: %d points, but a patch names point %d", r->line, (int)known,
                       (int)most);
    float *point = wr_try_alloc((size_t)known, 3 * sizeof *point, "points of patches", err);
    bool good = point != NULL;
    for (int32_t i = 0; i < known && good; i++) good = read_point(r, point + 3 * (size_t)i, err);
    for (int32_t i = 0; i < 16 * count && good; i++) {
        float *to = points[i / 16] + 3 * (i % 16);
        memcpy(to, point + 3 * ((size_t)*to - 1), 3 * sizeof *to);
    }
    wr_free(point);
    return good;
}

/* True if the next line has two numbers: then blocks follow, else a list with sixteen. */
static bool blocks_follow(Reader r)
{
    size_t length;
    (void)next_word(&r, &length);
    const int line = r.line;
    (void)next_word(&r, &length);
    skip_space(&r);
    return r.line > line;
}

bool wr_patches_parse(const char *text, size_t length, float (**points)[48], int32_t *count,
                      WrError *err)
{
    Reader r = { text, text + length, 1 };
    size_t left;
    if (!read_whole(&r, 1, WR_PATCHES_MAX, "the count of patches", count, err)) return false;
    *points = wr_try_alloc((size_t)*count, sizeof **points, "patches", err);
    if (!*points) return false;
    bool good = blocks_follow(r) ? read_blocks(&r, *points, *count, err)
                                 : read_list(&r, *points, *count, err);
    const char *rest = good ? next_word(&r, &left) : NULL;
    if (good && left > 0)
        good = bad_word(&r, rest, left, "expected: all patches have been read, the end", err);
    if (good) return true;
    wr_free(*points);
    *points = NULL;
    return false;
}
