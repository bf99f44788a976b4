#include "image/obj.h"

#include "base/memory.h"
#include "base/text.h"
#include "image/mesh_make.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define DIGITS 18 /* of a number, whose value is then right but for some 1e-16 of it */
#define ALIKE                                                                                      \
    32 /* points of one place that are looked through; equal ones past them are not made one */
#define NOTHING (-1)
#define NO_MATERIAL "DefaultMaterial" /* as good as none */

/* Indices of a place, of (u,v) and of a normal, or NOTHING. */
typedef struct Corner {
    int32_t v, vt, vn;
} Corner;

typedef struct Point {
    Corner is;
    int32_t next; /* 1 + another of its place; 0: no more */
} Point;

typedef struct Obj {
    bool whole;
    float (*v)[3], (*vt)[3], (*vn)[3];
    int32_t v_count, vt_count, vn_count, face_count;
    int32_t *first; /* of each place: 1 + its latest point */
    Point *points;
    int32_t (*corners)[3];
    WrMeshPart *parts;
    int32_t point_count, triangle_count, part_count;
    char object[WR_MESH_NAME], material[WR_MESH_NAME];
} Obj;

/* What is left of a line, without blanks at its end. */
typedef struct Line {
    const char *at, *end;
} Line;

/* ---- lines and words ---- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static void skip_blanks(Line *line)
{
    while (line->at < line->end && is_blank(*line->at)) line->at++;
}

/* The next line; false at the end of the file. */
static bool next_line(const char **at, const char *end, Line *line)
{
    if (*at == end) return false;
    const char *stop = memchr(*at, '\n', (size_t)(end - *at));
    *line = (Line){ *at, stop ? stop : end };
    *at = stop ? stop + 1 : end;
    skip_blanks(line);
    if (line->end > line->at && line->end[-1] == '\r') line->end--;
    while (line->end > line->at && is_blank(line->end[-1])) line->end--;
    return true;
}

/* Whether the line's first word is this one, which is then passed over. */
static bool take_word(Line *line, const char *word)
{
    const size_t n = strlen(word), left = (size_t)(line->end - line->at);
    if (left < n || memcmp(line->at, word, n) != 0 || (left > n && !is_blank(line->at[n])))
        return false;
    line->at += n;
    skip_blanks(line);
    return true;
}

/* ---- numbers ---- */

/* Digits, added to *value; how many. */
static int take_digits(Line *line, uint64_t *value)
{
    const char *from = line->at;
    for (; line->at < line->end; line->at++) {
        const unsigned digit = (unsigned)*line->at - '0';
        if (digit > 9) break;
        *value = *value * 10 + digit;
    }
    return line->at - from > DIGITS ? DIGITS + 1 : (int)(line->at - from);
}

static bool take_sign(Line *line)
{
    const bool minus = line->at < line->end && *line->at == '-';
    if (minus || (line->at < line->end && *line->at == '+')) line->at++;
    return minus;
}

/* A number of any other form, from its first letter. */
static bool odd_number(Line *line, const char *from, float *out)
{
    double value;
    line->at = from;
    while (line->at < line->end && !is_blank(*line->at)) line->at++;
    if (!wr_number_parse(from, (size_t)(line->at - from), &value)) return false;
    *out = (float)value;
    return isfinite(*out);
}

static bool take_number(Line *line, float *out)
{
    static const double tens[DIGITS + 1] = { 1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                             1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                             1e14, 1e15, 1e16, 1e17, 1e18 };
    skip_blanks(line);
    const char *from = line->at;
    const bool minus = take_sign(line);
    uint64_t digits = 0;
    int whole = take_digits(line, &digits), places = 0;
    if (line->at < line->end && *line->at == '.') {
        line->at++;
        places = take_digits(line, &digits);
    }
    if (whole + places == 0 || whole + places > DIGITS ||
        (line->at < line->end && !is_blank(*line->at)))
        return odd_number(line, from, out);
    const double value = (double)digits / tens[places];
    *out = (float)(minus ? -value : value);
    return true;
}

/* Three numbers, or from `least` on; what follows them in up to `most`, such as colours, is passed over. */
static bool take_numbers(Line *line, int least, int most, float out[3])
{
    int count = 0;
    float beyond;
    for (; line->at < line->end && count < most; count++)
        if (!take_number(line, count < 3 ? &out[count] : &beyond)) return false;
    return line->at == line->end && (count == least || count == most);
}

/* ---- faces ---- */

/* An index from 1, or from the end downwards, among so many. */
static bool take_index(Line *line, int32_t count, int32_t *out)
{
    const bool minus = take_sign(line);
    uint64_t value = 0;
    const int digits = take_digits(line, &value);
    if (digits < 1 || digits > DIGITS || value < 1 || value > (uint64_t)count) return false;
    *out = minus ? count - (int32_t)value : (int32_t)value - 1;
    return true;
}

static bool take_slash(Line *line)
{
    const bool there = line->at < line->end && *line->at == '/';
    if (there) line->at++;
    return there;
}

/* v, v/vt, v//vn or v/vt/vn. */
static bool take_corner(const Obj *obj, Line *line, Corner *out)
{
    Corner corner = { NOTHING, NOTHING, NOTHING };
    if (!take_index(line, obj->v_count, &corner.v)) return false;
    if (take_slash(line)) {
        const bool bare = line->at < line->end && *line->at == '/';
        if (!bare && !take_index(line, obj->vt_count, &corner.vt)) return false;
        if ((take_slash(line) || bare) && !take_index(line, obj->vn_count, &corner.vn))
            return false;
    }
    if (line->at < line->end && !is_blank(*line->at)) return false;
    skip_blanks(line);
    *out = corner;
    return true;
}

static int32_t find_point(Obj *obj, Corner c)
{
    if (!obj->whole) c.vt = c.vn = NOTHING;
    int32_t i = obj->first[c.v];
    for (int k = 0; i && k < ALIKE; k++) {
        const Point *p = &obj->points[i - 1];
        if (p->is.vt == c.vt && p->is.vn == c.vn) return i - 1;
        i = p->next;
    }
    obj->points[obj->point_count] = (Point){ c, obj->first[c.v] };
    obj->first[c.v] = obj->point_count + 1;
    return obj->point_count++;
}

/* The part that the next triangle belongs to: neighbours of one name are one; past the most that are told apart, all that
   follow. */
static WrMeshPart *part_of(Obj *obj)
{
    const char *name = obj->material[0] ? obj->material : obj->object;
    const int32_t count = obj->part_count;
    if (count == WR_MESH_PARTS_MAX || (count > 0 && !strcmp(obj->parts[count - 1].name, name)))
        return &obj->parts[count - 1];
    WrMeshPart *part = &obj->parts[obj->part_count++];
    part->first = obj->triangle_count;
    memcpy(part->name, name, sizeof part->name);
    return part;
}

/* Of the angle there; 0 where an edge has no length. */
static double cosine(const float *at, const float *a, const float *b)
{
    double ab = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; k++) {
        const double u = (double)a[k] - (double)at[k], w = (double)b[k] - (double)at[k];
        ab += u * w, aa += u * u, bb += w * w;
    }
    return aa * bb > 0 ? ab / sqrt(aa * bb) : 0;
}

/* The corner whose diagonal cuts a quadrilateral: the one where it is more than a straight angle, if any, where the two
   angles beside the diagonal have a + b > pi, thus cos a + cos b < 0. */
static int cut_from(const Obj *obj, const Corner c[4])
{
    for (int i = 0; i < 4; i++) {
        const float *at = obj->v[c[i].v], *across = obj->v[c[(i + 2) % 4].v];
        if (cosine(at, obj->v[c[(i + 1) % 4].v], across) +
                cosine(at, obj->v[c[(i + 3) % 4].v], across) <
            -1e-6)
            return i;
    }
    return 0;
}

/* Points are found in the order of the file's corners, as the library has them. */
static void add_face(Obj *obj, const Corner *c, int count)
{
    const int from = count == 4 ? cut_from(obj, c) : 0;
    int32_t point[4];
    WrMeshPart *part = part_of(obj);
    for (int i = 0; i < count; i++) point[i] = find_point(obj, c[i]);
    for (int i = 1; i < count - 1; i++) {
        int32_t *to = obj->corners[obj->triangle_count++];
        to[0] = point[from], to[1] = point[(from + i) % count],
        to[2] = point[(from + i + 1) % count];
        part->count++;
    }
}

static bool read_face(Obj *obj, Line *line)
{
    Corner c[4];
    int count = 0;
    for (; line->at < line->end; count++) {
        if (count == 4 || !take_corner(obj, line, &c[count])) return false;
        if ((c[count].vt < 0) != (c[0].vt < 0) || (c[count].vn < 0) != (c[0].vn < 0)) return false;
    }
    if (count < 3 || obj->triangle_count + 2 > WR_MESH_TRIANGLES_MAX ||
        obj->point_count + 4 > WR_MESH_POINTS_MAX)
        return false;
    add_face(obj, c, count);
    return true;
}

/* ---- the file ---- */

static bool is_place(const float p[3])
{
    return fabsf(p[0]) <= 1e30f && fabsf(p[1]) <= 1e30f && fabsf(p[2]) <= 1e30f;
}

static void take_name(const Line *line, char name[WR_MESH_NAME])
{
    size_t n = (size_t)(line->end - line->at);
    if (n == 0) return;
    if (n >= WR_MESH_NAME) n = WR_MESH_NAME - 1;
    memset(name, 0, WR_MESH_NAME);
    memcpy(name, line->at, n);
}

/* Lines of words. Another end of line within one, or a line that goes on in the next, is for the library. */
static bool read_words(Obj *obj, Line *line)
{
    const size_t n = (size_t)(line->end - line->at);
    if (n == 0) return true;
    if (line->end[-1] == '\\' || memchr(line->at, '\r', n) || memchr(line->at, 0, n)) return false;
    if (*line->at == '#' || take_word(line, "s") || take_word(line, "mtllib")) return true;
    if (take_word(line, "usemtl")) {
        take_name(line, obj->material);
        if (strcmp(obj->material, NO_MATERIAL) == 0) obj->material[0] = '\0';
        return true;
    }
    if (!take_word(line, "o") && !take_word(line, "g")) return false;
    take_name(line, obj->object);
    return true;
}

static bool read_line(Obj *obj, Line line)
{
    if (take_word(&line, "f")) return read_face(obj, &line);
    if (take_word(&line, "v")) {
        float *p = obj->v[obj->v_count++];
        return take_numbers(&line, 3, 6, p) && is_place(p);
    }
    if (take_word(&line, "vt")) return take_numbers(&line, 2, 3, obj->vt[obj->vt_count++]);
    if (take_word(&line, "vn")) return take_numbers(&line, 3, 3, obj->vn[obj->vn_count++]);
    return read_words(obj, &line);
}

/* How many of each there are, so that each array is made once. */
static void count_lines(Obj *obj, const char *at, const char *end)
{
    Line line;
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
    obj->points = room(4 * faces, sizeof *obj->points);
    obj->corners = room(2 * faces, sizeof *obj->corners);
    obj->parts = room(WR_MESH_PARTS_MAX, sizeof *obj->parts);
    obj->v_count = obj->vt_count = obj->vn_count = 0;
    return obj->v && obj->vt && obj->vn && obj->first && obj->points && obj->corners && obj->parts;
}

static void free_all(Obj *obj)
{
    wr_free(obj->v);
    wr_free(obj->vt);
    wr_free(obj->vn);
    wr_free(obj->first);
    wr_free(obj->points);
    wr_free(obj->corners);
    wr_free(obj->parts);
}

/* ---- what comes of it ---- */

static void add(WrText *block, const void *from, size_t bytes)
{
    wr_text_add_n(block, from, bytes);
}

static void add_whole(const Obj *obj, WrText *block)
{
    static const float none[3] = { 0, 0, 0 }, unmapped[2] = { NAN, NAN };
    for (int32_t i = 0; i < obj->point_count; i++) {
        const int32_t vn = obj->points[i].is.vn;
        add(block, vn < 0 ? none : obj->vn[vn], sizeof none);
    }
    for (int32_t i = 0; i < obj->point_count; i++) {
        const int32_t vt = obj->points[i].is.vt;
        add(block, vt < 0 ? unmapped : obj->vt[vt], sizeof unmapped);
    }
    add(block, obj->parts, (size_t)obj->part_count * sizeof *obj->parts);
}

static void add_mesh(const Obj *obj, WrText *block)
{
    const WrMeshHead head = { obj->point_count, obj->triangle_count, obj->whole,
                              obj->whole ? obj->part_count : 0 };
    add(block, &head, sizeof head);
    for (int32_t i = 0; i < obj->point_count; i++)
        add(block, obj->v[obj->points[i].is.v], sizeof *obj->v);
    add(block, obj->corners, (size_t)obj->triangle_count * sizeof *obj->corners);
    if (obj->whole) add_whole(obj, block);
}

bool wr_obj_make(const char *bytes, size_t length, bool whole, WrText *block)
{
    Obj obj = { .whole = whole, .object = "defaultobject" };
    const char *at = bytes, *end = bytes + length;
    Line line;
    count_lines(&obj, bytes, end);
    bool good = make_room(&obj);
    while (good && next_line(&at, end, &line)) good = read_line(&obj, line);
    if (good) add_mesh(&obj, block);
    free_all(&obj);
    return good;
}
