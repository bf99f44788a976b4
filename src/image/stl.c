#include "image/stl.h"

#include "base/error.h"
#include "base/text.h"
#include "image/mesh_build.h"
#include "image/scan.h"

#include <stdint.h>
#include <string.h>

#define HEAD 84    /* bytes: a title of 80, the number of triangles */
#define RECORD 50  /* bytes: a normal, three points, two unused bytes */
#define CORNERS 64 /* corners of an ASCII facet; the format has 3 */

/* ---- binary ---- */

static uint32_t number_at(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static float float_at(const char *at)
{
    const uint32_t bits = number_at(at);
    float out;
    memcpy(&out, &bits, sizeof out);
    return out;
}

static bool add_record(WrMeshBuild *build, const char *at, WrError *err)
{
    const int32_t first = build->point_count;
    float normal[3];
    for (int k = 0; k < 3; k++) normal[k] = float_at(at + 4 * k);
    for (int i = 1; i <= 3; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = (double)float_at(at + 12 * i + 4 * k);
        if (!wr_mesh_build_point(build, p, normal, NULL, err)) return false;
    }
    return wr_mesh_build_triangle(build, first, first + 1, first + 2, err);
}

static bool read_binary(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    if (length < HEAD)
        return wr_fail(err, "is cut off: %zu bytes, where an STL file has %d and more", length,
                       HEAD);
    const uint32_t count = number_at(bytes + 80);
    if (count > (length - HEAD) / RECORD)
        return wr_fail(err,
                       "says that it holds %u triangles in %zu bytes; it is damaged or cut off",
                       (unsigned)count, length - HEAD);
    if (!wr_mesh_build_reserve(build, 3 * (int64_t)count, count, err)) return false;
    for (uint32_t i = 0; i < count; i++)
        if (!add_record(build, bytes + HEAD + (size_t)RECORD * i, err)) return false;
    return true;
}

/* ---- ASCII ---- */

typedef struct Stl {
    WrScan scan;
    WrMeshBuild *build;
    int64_t facet; /* from 1 */
    float normal[3];
    int32_t corners[CORNERS];
    int32_t count; /* of the present facet */
} Stl;

static bool is_word(const char *word, size_t length, const char *name)
{
    char small[16];
    if (length >= sizeof small) return false;
    memcpy(small, word, length);
    small[length] = '\0';
    return wr_text_same_letters(small, name);
}

static bool take_three(Stl *stl, const char *what, double out[3], WrError *err)
{
    for (int k = 0; k < 3; k++) {
        wr_scan_space(&stl->scan);
        const char *from = stl->scan.at;
        if (from == stl->scan.end)
            return wr_fail(err, "is cut off in facet %lld", (long long)stl->facet);
        if (wr_scan_any_number(&stl->scan, &out[k])) continue;
        const size_t length = (size_t)(stl->scan.at - from);
        return wr_fail(err, "is damaged: facet %lld has a %s with \"%.*s\" for a number",
                       (long long)stl->facet, what, (int)(length < 40 ? length : 40), from);
    }
    return true;
}

static bool begin_facet(Stl *stl, WrError *err)
{
    const char *word;
    double n[3];
    stl->facet++;
    stl->count = 0;
    memset(stl->normal, 0, sizeof stl->normal);
    wr_scan_space(&stl->scan);
    const WrScan before = stl->scan;
    const size_t length = wr_scan_word(&stl->scan, &word);
    if (!is_word(word, length, "normal")) {
        stl->scan = before; /* a facet without a normal */
        return true;
    }
    if (!take_three(stl, "normal", n, err)) return false;
    for (int k = 0; k < 3; k++) stl->normal[k] = (float)n[k];
    return true;
}

static bool add_vertex(Stl *stl, WrError *err)
{
    double p[3];
    if (stl->facet == 0) return wr_fail(err, "is damaged: it has a vertex before any facet");
    if (!take_three(stl, "vertex", p, err)) return false;
    if (stl->count == CORNERS)
        return wr_fail(err, "is damaged: facet %lld has more than %d corners",
                       (long long)stl->facet, CORNERS);
    stl->corners[stl->count++] = stl->build->point_count;
    return wr_mesh_build_point(stl->build, p, stl->normal, NULL, err);
}

static bool end_facet(Stl *stl, WrError *err)
{
    if (stl->count < 3)
        return wr_fail(err, "is damaged: facet %lld has %d corners: must be 3",
                       (long long)stl->facet, (int)stl->count);
    const bool good = wr_mesh_build_polygon(stl->build, stl->corners, stl->count, err);
    stl->count = 0;
    return good;
}

/* The rest of the line is the name of the solid. */
static void begin_solid(Stl *stl)
{
    const char *from, *to;
    wr_scan_blanks(&stl->scan);
    from = to = stl->scan.at;
    for (; stl->scan.at < stl->scan.end && (unsigned char)*stl->scan.at != '\n'; stl->scan.at++)
        if ((unsigned char)*stl->scan.at > ' ') to = stl->scan.at + 1;
    wr_mesh_build_part(stl->build, from, (size_t)(to - from));
}

static bool take_word(Stl *stl, const char *word, size_t length, WrError *err)
{
    if (is_word(word, length, "vertex")) return add_vertex(stl, err);
    if (is_word(word, length, "facet")) return begin_facet(stl, err);
    if (is_word(word, length, "endfacet")) return end_facet(stl, err);
    if (is_word(word, length, "solid") || is_word(word, length, "endsolid")) begin_solid(stl);
    else if (!is_word(word, length, "outer") && !is_word(word, length, "loop") &&
             !is_word(word, length, "endloop"))
        return wr_fail(err, "is damaged: after facet %lld stands \"%.*s\"", (long long)stl->facet,
                       (int)(length < 40 ? length : 40), word);
    return true;
}

static bool read_text(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    Stl stl = { .scan = { bytes, bytes + length }, .build = build };
    const char *word;
    size_t n;
    for (wr_scan_space(&stl.scan); (n = wr_scan_word(&stl.scan, &word)) > 0;
         wr_scan_space(&stl.scan))
        if (!take_word(&stl, word, n, err)) return false;
    return stl.count == 0 || wr_fail(err, "is cut off in facet %lld", (long long)stl.facet);
}

/* Titles of binary files may also begin with "solid"; their length distinguishes them. */
static bool is_text(const char *bytes, size_t length)
{
    WrScan scan = { bytes, bytes + length };
    const char *word;
    if (length >= HEAD && HEAD + RECORD * (uint64_t)number_at(bytes + 80) == length) return false;
    wr_scan_space(&scan);
    const size_t n = wr_scan_word(&scan, &word);
    return is_word(word, n, "solid") || is_word(word, n, "facet");
}

bool wr_stl_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    return is_text(bytes, length) ? read_text(bytes, length, build, err)
                                  : read_binary(bytes, length, build, err);
}
