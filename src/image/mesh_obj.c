#include "image/mesh_obj.h"

#include "base/memory.h"
#include "image/mesh_build.h"
#include "image/scan.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define NOTHING (-1)
#define CORNERS_MOST 65536            /* of one polygon */
#define NO_MATERIAL "DefaultMaterial" /* treated as no material */

/* Indices of a position, of (u,v) and of a normal, or NOTHING. */
typedef struct Corner {
    int32_t v, vt, vn;
} Corner;

typedef struct Obj {
    WrMeshBuild *build;
    double (*v)[3];
    float (*vt)[2], (*vn)[3];
    int32_t v_count, vt_count, vn_count, face_count;
    int32_t *first;   /* for each position: 1 + its latest point */
    int32_t *polygon; /* [CORNERS_MOST] */
    char object[WR_MESH_NAME], material[WR_MESH_NAME];
} Obj;

/* ---- lines and words ---- */

static void trim(WrScan *line)
{
    while (line->end > line->at && (unsigned char)line->end[-1] <= ' ') line->end--;
}

/* The next line without surrounding blanks; false at the end of the file. */
static bool next_line(const char **at, const char *end, WrScan *line)
{
    if (*at == end) return false;
    const char *stop = memchr(*at, '\n', (size_t)(end - *at));
    *line = (WrScan){ *at, stop ? stop : end };
    *at = stop ? stop + 1 : end;
    wr_scan_blanks(line);
    trim(line);
    return true;
}

/* Removes a trailing comment from a line of numbers. Names may contain a #. */
static void cut_remark(WrScan *line)
{
    const char *remark = memchr(line->at, '#', (size_t)(line->end - line->at));
    if (remark) line->end = remark;
    trim(line);
}

/* Skips the line's first word if it is this one. */
static bool take_word(WrScan *line, const char *word)
{
    const size_t n = strlen(word), left = (size_t)(line->end - line->at);
    if (left < n || memcmp(line->at, word, n) != 0 ||
        (left > n && line->at[n] != ' ' && line->at[n] != '\t'))
        return false;
    line->at += n;
    wr_scan_blanks(line);
    return true;
}

/* Reads `least` to `most` numbers up to the end of the line; absent ones are unchanged. Returns their
 * number, or -1. */
static int take_numbers(WrScan *line, int least, int most, double *out)
{
    int count = 0;
    for (; line->at < line->end && count < most; count++, wr_scan_blanks(line))
        if (!wr_scan_number(line, &out[count])) return -1;
    return line->at == line->end && count >= least ? count : -1;
}

/* ---- positions, (u,v), normals ---- */

static bool is_float(double x)
{
    return isfinite((float)x);
}

/* x y z, then a weight, or colours, or a weight and colours, or colours with alpha. A weight other than
   1 is a rational curve. */
static bool read_place(Obj *obj, WrScan *line)
{
    double p[7];
    const int count = take_numbers(line, 3, 7, p);
    if (count < 3 || count == 5 || (count == 4 && (p[3] < 1 || p[3] > 1))) return false;
    for (int k = 0; k < 3; k++)
        if (!(fabs(p[k]) <= 1e30)) return false;
    memcpy(obj->v[obj->v_count++], p, 3 * sizeof *p);
    return true;
}

static bool read_uv(Obj *obj, WrScan *line)
{
    double p[3] = { 0, 0, 0 };
    if (take_numbers(line, 1, 3, p) < 1 || !is_float(p[0]) || !is_float(p[1])) return false;
    for (int k = 0; k < 2; k++) obj->vt[obj->vt_count][k] = (float)p[k];
    obj->vt_count++;
    return true;
}

static bool read_normal(Obj *obj, WrScan *line)
{
    double p[3];
    if (take_numbers(line, 3, 3, p) < 3) return false;
    for (int k = 0; k < 3; k++) {
        if (!is_float(p[k])) return false;
        obj->vn[obj->vn_count][k] = (float)p[k];
    }
    obj->vn_count++;
    return true;
}

/* ---- faces ---- */

/* An index from 1, or a negative one from the end. */
static bool take_index(WrScan *line, int32_t count, int32_t *out)
{
    const bool minus = line->at < line->end && *line->at == '-';
    const char *from = line->at += minus;
    int64_t value = 0;
    for (; line->at < line->end && (unsigned)*line->at - '0' <= 9 && value <= count; line->at++)
        value = value * 10 + (*line->at - '0');
    if (line->at == from || value < 1 || value > count) return false;
    *out = minus ? count - (int32_t)value : (int32_t)value - 1;
    return true;
}

static bool take_slash(WrScan *line)
{
    const bool there = line->at < line->end && *line->at == '/';
    line->at += there;
    return there;
}

static bool is_bare(const WrScan *line)
{
    return line->at == line->end || *line->at == '/' || (unsigned char)*line->at <= ' ';
}

/* v, v/vt, v//vn or v/vt/vn; also with nothing after a slash. */
static bool take_corner(const Obj *obj, WrScan *line, Corner *out)
{
    Corner corner = { NOTHING, NOTHING, NOTHING };
    if (!take_index(line, obj->v_count, &corner.v)) return false;
    if (take_slash(line) && !is_bare(line) && !take_index(line, obj->vt_count, &corner.vt))
        return false;
    if (take_slash(line) && !is_bare(line) && !take_index(line, obj->vn_count, &corner.vn))
        return false;
    if (line->at < line->end && (unsigned char)*line->at > ' ') return false;
    wr_scan_blanks(line);
    *out = corner;
    return true;
}

static bool read_face(Obj *obj, WrScan *line)
{
    Corner c;
    int32_t count = 0;
    const char *name = obj->material[0] ? obj->material : obj->object;
    for (; line->at < line->end; count++) {
        if (count == CORNERS_MOST || !take_corner(obj, line, &c)) return false;
        obj->polygon[count] = wr_mesh_build_wedge(obj->build, &obj->first[c.v], obj->v[c.v],
                                                  c.vn < 0 ? NULL : obj->vn[c.vn],
                                                  c.vt < 0 ? NULL : obj->vt[c.vt], NULL);
        if (obj->polygon[count] < 0) return false;
    }
    if (count < 3) return false;
    wr_mesh_build_part(obj->build, name, strlen(name));
    return wr_mesh_build_polygon(obj->build, obj->polygon, count, NULL);
}

/* ---- the file ---- */

static void take_name(const WrScan *line, char name[WR_MESH_NAME])
{
    size_t n = (size_t)(line->end - line->at);
    if (n == 0) return;
    if (n >= WR_MESH_NAME) n = WR_MESH_NAME - 1;
    memset(name, 0, WR_MESH_NAME);
    memcpy(name, line->at, n);
}

/* Lines of words. Other line ends within a line, or a continued line, are left to the library. */
static bool read_words(Obj *obj, WrScan *line)
{
    static const char *const unused[] = { "s", "mtllib", "p", "l" };
    const size_t n = (size_t)(line->end - line->at);
    if (n == 0 || *line->at == '#') return true;
    if (line->end[-1] == '\\' || memchr(line->at, '\r', n) || memchr(line->at, 0, n)) return false;
    for (size_t i = 0; i < sizeof unused / sizeof *unused; i++)
        if (take_word(line, unused[i])) return true;
    if (take_word(line, "usemtl")) {
        take_name(line, obj->material);
        if (strcmp(obj->material, NO_MATERIAL) == 0) obj->material[0] = '\0';
        return true;
    }
    if (!take_word(line, "o") && !take_word(line, "g")) return false;
    take_name(line, obj->object);
    return true;
}

static bool read_line(Obj *obj, WrScan line)
{
    static const struct {
        const char *word;
        bool (*read)(Obj *obj, WrScan *line);
    } kinds[] = {
        { "f", read_face }, { "v", read_place }, { "vt", read_uv }, { "vn", read_normal }
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (!take_word(&line, kinds[i].word)) continue;
        cut_remark(&line);
        return kinds[i].read(obj, &line);
    }
    return read_words(obj, &line);
}

/* Counts the elements, so that each array is allocated once. */
static void count_lines(Obj *obj, const char *at, const char *end)
{
    WrScan line;
    while (next_line(&at, end, &line)) {
        if (take_word(&line, "f")) obj->face_count++;
        else if (take_word(&line, "v")) obj->v_count++;
        else if (take_word(&line, "vt")) obj->vt_count++;
        else if (take_word(&line, "vn")) obj->vn_count++;
    }
}

static void *room(int32_t count, size_t size)
{
    return wr_try_alloc((size_t)count + 1, size, "a mesh", NULL);
}

static bool make_room(Obj *obj)
{
    const int32_t faces = obj->face_count;
    if (faces < 1 || faces > WR_MESH_TRIANGLES_MAX || obj->v_count > WR_MESH_POINTS_MAX)
        return false;
    obj->v = room(obj->v_count, sizeof *obj->v);
    obj->vt = room(obj->vt_count, sizeof *obj->vt);
    obj->vn = room(obj->vn_count, sizeof *obj->vn);
    obj->first = room(obj->v_count, sizeof *obj->first);
    obj->polygon = room(CORNERS_MOST, sizeof *obj->polygon);
    const int32_t points = obj->v_count;
    obj->v_count = obj->vt_count = obj->vn_count = 0;
    return obj->v && obj->vt && obj->vn && obj->first && obj->polygon &&
           wr_mesh_build_reserve(obj->build, points, faces, NULL);
}

static void free_all(Obj *obj)
{
    wr_free(obj->v);
    wr_free(obj->vt);
    wr_free(obj->vn);
    wr_free(obj->first);
    wr_free(obj->polygon);
}

/* 0,5 for 0.5. The library reads it as 0 and drops the rest. */
static bool has_decimal_comma(WrScan line)
{
    bool numbers = take_word(&line, "v") || take_word(&line, "vt") || take_word(&line, "vn");
    cut_remark(&line);
    return numbers && memchr(line.at, ',', (size_t)(line.end - line.at));
}

bool wr_obj_read(const char *bytes, size_t length, WrMeshBuild *build, const char **wrong)
{
    Obj obj = { .build = build, .object = "defaultobject" };
    const bool mark = length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0;
    const char *start = bytes + (mark ? 3 : 0), *end = bytes + length, *at = start;
    WrScan line;
    count_lines(&obj, start, end);
    bool good = make_room(&obj);
    while (good && next_line(&at, end, &line)) good = read_line(&obj, line);
    *wrong = !good && at > start && has_decimal_comma(line)
                 ? "has numbers with a decimal comma; save it with decimal points"
                 : NULL;
    free_all(&obj);
    return good;
}
