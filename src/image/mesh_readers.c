/* Readers of OBJ, PLY and STL files. */
#include "image/mesh_readers.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/mesh_build.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef struct WrScan {
    const char *at, *end;
} WrScan;

/* ---- text cursor and numbers ---- */

#define DIGITS 18 /* digits that fit into 64 bits */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static bool is_space(char c)
{
    return (unsigned char)c <= ' ';
}

/* Skips blanks and tabs; the second also skips line ends. */
static void scan_blanks(WrScan *scan)
{
    while (scan->at < scan->end && is_blank(*scan->at)) scan->at++;
}

static void scan_space(WrScan *scan)
{
    while (scan->at < scan->end && is_space(*scan->at)) scan->at++;
}

/* Reads the word at the cursor, up to a space, a control character or the end. Returns its length, 0 at
 * the end. */
static size_t scan_word(WrScan *scan, const char **word)
{
    *word = scan->at;
    while (scan->at < scan->end && !is_space(*scan->at)) scan->at++;
    return (size_t)(scan->at - *word);
}

/* Reads digits into *value; returns their number. */
static int take_digits(WrScan *scan, uint64_t *value)
{
    const char *from = scan->at;
    for (; scan->at < scan->end; scan->at++) {
        const unsigned digit = (unsigned)*scan->at - '0';
        if (digit > 9) break;
        *value = *value * 10 + digit;
    }
    return scan->at - from > DIGITS ? DIGITS + 1 : (int)(scan->at - from);
}

/* A number of any other form, from its first letter. */
static bool odd_number(WrScan *scan, const char *from, double *out)
{
    const char *word;
    scan->at = from;
    const size_t length = scan_word(scan, &word);
    return wr_number_parse(word, length, out);
}

/* Reads a decimal number that ends with its word, with a decimal point in any locale. false: no number,
 * or beyond double. Up to 18 digits without an exponent are accurate to 1e-16 of the value; all others
 * are the nearest double. */
static bool scan_number(WrScan *scan, double *out)
{
    static const double tens[DIGITS + 1] = { 1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                             1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                             1e14, 1e15, 1e16, 1e17, 1e18 };
    const char *from = scan->at;
    const bool minus = from < scan->end && *from == '-';
    if (minus || (from < scan->end && *from == '+')) scan->at++;
    uint64_t digits = 0;
    int whole = take_digits(scan, &digits), places = 0;
    if (scan->at < scan->end && *scan->at == '.') {
        scan->at++;
        places = take_digits(scan, &digits);
    }
    if (whole + places == 0 || whole + places > DIGITS ||
        (scan->at < scan->end && !is_space(*scan->at)))
        return odd_number(scan, from, out);
    /* Up to 18 digits fit 64 bits, and powers of ten up to 10^22 are exact in double: one rounding on conversion, one on
       division. strtod would be exact, but depends on the locale and is several times slower on files of millions of numbers. */
    const double value = (double)digits / tens[places];
    *out = minus ? -value : value;
    return true;
}

/* scan_number that also accepts nan, inf, -inf and similar words. */
static bool scan_any_number(WrScan *scan, double *out)
{
    static const char *const nothing[] = { "nan", "-nan", "nan(ind)", "-nan(ind)" };
    const char *from = scan->at;
    char word[16] = "";
    if (scan_number(scan, out)) return true;
    const size_t length = (size_t)(scan->at - from);
    if (length >= sizeof word) return false;
    memcpy(word, from, length);
    for (size_t i = 0; i < sizeof nothing / sizeof *nothing; i++)
        if (wr_text_same_letters(word, nothing[i])) {
            *out = NAN;
            return true;
        }
    const bool minus = *word == '-';
    const char *bare = word + (minus || *word == '+');
    if (!wr_text_same_letters(bare, "inf") && !wr_text_same_letters(bare, "infinity")) return false;
    *out = minus ? -INFINITY : INFINITY;
    return true;
}

/* ---- OBJ ---- */

#define NOTHING (-1)
#define CORNERS_MAX 65536             /* of one polygon */
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
    int32_t *polygon; /* [CORNERS_MAX] */
    WrError *wrong;   /* set for files that the library would not read either */
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
    scan_blanks(line);
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
    scan_blanks(line);
    return true;
}

/* Reads `least` to `most` numbers, or words for none, up to the end of the line; absent ones are unchanged. Returns
 * their number, or -1. */
static int take_numbers(WrScan *line, int least, int most, double *out)
{
    int count = 0;
    for (; line->at < line->end && count < most; count++, scan_blanks(line))
        if (!scan_any_number(line, &out[count])) return -1;
    return line->at == line->end && count >= least ? count : -1;
}

/* ---- positions, (u,v), normals ---- */

static bool is_float(double x)
{
    return isfinite((float)x);
}

static bool refuse_place(Obj *obj, const double p[3])
{
    return wr_fail(obj->wrong, "point %d is %g,%g,%g: coordinates are numbers from -1e30 to 1e30",
                   (int)obj->v_count + 1, p[0], p[1], p[2]);
}

/* x y z, then a weight, or colours, or a weight and colours, or colours with alpha. A weight other than
   1 is a rational curve. */
static bool read_place(Obj *obj, WrScan *line)
{
    double p[7];
    const int count = take_numbers(line, 3, 7, p);
    if (count < 3 || count == 5 || (count == 4 && !(p[3] >= 1 && p[3] <= 1))) return false;
    for (int k = 0; k < 3; k++)
        if (!(fabs(p[k]) <= 1e30)) return refuse_place(obj, p);
    memcpy(obj->v[obj->v_count++], p, 3 * sizeof *p);
    return true;
}

static bool read_uv(Obj *obj, WrScan *line)
{
    double p[3] = { 0, 0, 0 };
    if (take_numbers(line, 1, 3, p) < 1) return false;
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
    scan_blanks(line);
    *out = corner;
    return true;
}

/* An OBJ corner is a triple of indices; a mesh point is a place with one normal and one (u,v). Each place keeps a chain of
   its wedges (points with this place), and a corner reuses the one with the same normal and (u,v). */
static bool read_face(Obj *obj, WrScan *line)
{
    Corner c;
    int32_t count = 0;
    const char *name = obj->material[0] ? obj->material : obj->object;
    for (; line->at < line->end; count++) {
        if (count == CORNERS_MAX || !take_corner(obj, line, &c)) return false;
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
    obj->polygon = room(CORNERS_MAX, sizeof *obj->polygon);
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

/* This reader accepts the common subset of OBJ and fails on anything else; the caller then tries the slower library (assimp),
   so no rare file is lost. Two passes: counts, then elements. */
bool wr_obj_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *wrong)
{
    Obj obj = { .build = build, .object = "defaultobject", .wrong = wrong };
    const bool mark = length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0;
    const char *start = bytes + (mark ? 3 : 0), *end = bytes + length, *at = start;
    WrScan line;
    count_lines(&obj, start, end);
    bool good = make_room(&obj);
    while (good && next_line(&at, end, &line)) good = read_line(&obj, line);
    if (!good && at > start && has_decimal_comma(line))
        wr_fail(wrong, "has numbers with a decimal comma; save it with decimal points");
    free_all(&obj);
    return good;
}

/* ---- PLY ---- */

#define ELEMENTS 32
#define PROPERTIES 256 /* of all elements together */
#define NAME 64

/* ---- types and roles ---- */

/* PLY: a text header names elements in file order, each with a count and a list of properties; the body holds all entries of
   the first element, then the second, without separators in binary files. A list is its length, then its values. Unknown
   elements and properties are read and dropped, since their sizes must be skipped. */
typedef enum Type { CHAR, UCHAR, SHORT, USHORT, INT, UINT, FLOAT, DOUBLE, TYPES } Type;

static const struct {
    const char *name, *other;
    int bytes;
} types[TYPES] = { { "char", "int8", 1 },     { "uchar", "uint8", 1 },   { "short", "int16", 2 },
                   { "ushort", "uint16", 2 }, { "int", "int32", 4 },     { "uint", "uint32", 4 },
                   { "float", "float32", 4 }, { "double", "float64", 8 } };

/* Use of a property; values before VALUES are indices into the values of an entry. */
typedef enum Role { X, Y, Z, NX, NY, NZ, U, V, VALUES, CORNERS = VALUES, TEXCOORD, UNUSED } Role;

typedef struct Property {
    Type type, count; /* count: type of a list's length */
    bool list;
    Role role;
} Property;

typedef struct Element {
    char name[NAME];
    int64_t count;
    int first, properties; /* indices among all properties */
} Element;

/* Values of one list. */
typedef struct List {
    double *at; /* owned */
    size_t count, room;
} List;

typedef struct Ply {
    WrScan scan;
    bool text, big; /* ASCII; big-endian binary */
    Element elements[ELEMENTS];
    Property properties[PROPERTIES];
    int element_count, property_count;
    const Element *element; /* element being read, and its entry, from 1 */
    int64_t entry;
    bool used[UNUSED]; /* roles that the present element has */
    double values[VALUES];
    List corners, texcoord;
    int32_t vertices;
    int32_t *first; /* [vertices] for each: 1 + its latest wedge */
    int32_t *polygon;
    size_t polygon_room;
    WrMeshBuild *build, *places; /* places: the file's vertices, which faces convert to points */
} Ply;

static const struct {
    const char *element, *property;
    Role role;
} roles[] = {
    { "vertex", "x", X },
    { "vertex", "y", Y },
    { "vertex", "z", Z },
    { "vertex", "nx", NX },
    { "vertex", "ny", NY },
    { "vertex", "nz", NZ },
    { "vertex", "u", U },
    { "vertex", "v", V },
    { "vertex", "s", U },
    { "vertex", "t", V },
    { "vertex", "texture_u", U },
    { "vertex", "texture_v", V },
    { "vertex", "texture_s", U },
    { "vertex", "texture_t", V },
    { "vertex", "tx", U },
    { "vertex", "ty", V },
    { "face", "vertex_index", CORNERS },
    { "face", "vertex_indices", CORNERS },
    { "face", "texcoord", TEXCOORD },
    { "tristrips", "vertex_indices", CORNERS },
    { "tristrips", "vertex_index", CORNERS },
};

/* ---- the header ---- */

bool wr_ply_is(const char *bytes, size_t length)
{
    return length >= 4 && memcmp(bytes, "ply", 3) == 0 && (unsigned char)bytes[3] <= ' ';
}

/* The next line, with the line end of the first line ("\n", "\r\n" or "\r"); false: truncated. */
static bool header_line(WrScan *scan, WrScan *line)
{
    const char *at = scan->at;
    while (at < scan->end && *at != '\n' && *at != '\r') at++;
    if (at == scan->end) return false;
    *line = (WrScan){ scan->at, at };
    scan->at = at + (*at == '\r' && at + 1 < scan->end && at[1] == '\n' ? 2 : 1);
    return true;
}

static bool next_word(WrScan *line, char out[NAME])
{
    const char *word;
    scan_space(line);
    const size_t length = scan_word(line, &word);
    snprintf(out, NAME, "%.*s", (int)(length < NAME ? length : NAME), word);
    return length > 0 && length < NAME;
}

static bool find_type(const char *name, Type *type, WrError *err)
{
    for (int i = 0; i < TYPES; i++)
        if (strcmp(name, types[i].name) == 0 || strcmp(name, types[i].other) == 0) {
            *type = (Type)i;
            return true;
        }
    return wr_fail(err,
                   "is damaged: its header has a property of type \"%s\"; types are char, uchar, "
                   "short, ushort, int, uint, float, double",
                   name);
}

static bool read_format(Ply *ply, WrScan *line, WrError *err)
{
    char kind[NAME];
    if (!next_word(line, kind)) return wr_fail(err, "is damaged: its format has no name");
    ply->text = strcmp(kind, "ascii") == 0;
    ply->big = strcmp(kind, "binary_big_endian") == 0;
    return ply->text || ply->big || strcmp(kind, "binary_little_endian") == 0 ||
           wr_fail(err,
                   "is damaged: format \"%s\": must be ascii, binary_little_endian or "
                   "binary_big_endian",
                   kind);
}

static bool read_element(Ply *ply, WrScan *line, WrError *err)
{
    char count[NAME];
    double value;
    if (ply->element_count == ELEMENTS)
        return wr_fail(err, "is damaged: its header has more than %d elements", ELEMENTS);
    Element *element = &ply->elements[ply->element_count++];
    element->first = ply->property_count;
    if (!next_word(line, element->name) || !next_word(line, count) ||
        !wr_number_parse(count, strlen(count), &value) || !(value >= 0 && value <= 1e15) ||
        value > floor(value))
        return wr_fail(err, "is damaged: element %d of its header has no name or no count",
                       ply->element_count);
    element->count = (int64_t)value;
    return true;
}

static bool read_property(Ply *ply, WrScan *line, WrError *err)
{
    char type[NAME], count[NAME], name[NAME];
    if (ply->element_count == 0)
        return wr_fail(err, "is damaged: its header has a property before any element");
    if (ply->property_count == PROPERTIES)
        return wr_fail(err, "is damaged: its header has more than %d properties", PROPERTIES);
    Element *element = &ply->elements[ply->element_count - 1];
    Property *property = &ply->properties[ply->property_count++];
    *property = (Property){ .role = UNUSED };
    element->properties++;
    bool whole = next_word(line, type);
    property->list = whole && strcmp(type, "list") == 0;
    if (property->list) whole = next_word(line, count) && next_word(line, type);
    if (!whole || !next_word(line, name))
        return wr_fail(err,
                       "is damaged: element %s of its header has a property without type or name",
                       element->name);
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++)
        if (strcmp(element->name, roles[i].element) == 0 && strcmp(name, roles[i].property) == 0 &&
            property->list == (roles[i].role >= CORNERS))
            property->role = roles[i].role;
    return find_type(type, &property->type, err) &&
           (!property->list || find_type(count, &property->count, err));
}

static bool read_header(Ply *ply, WrError *err)
{
    WrScan line;
    char word[NAME];
    bool format = false, good = header_line(&ply->scan, &line);
    while (good && header_line(&ply->scan, &line)) {
        next_word(&line, word);
        if (strcmp(word, "end_header") == 0)
            return format || wr_fail(err, "is damaged: its header names no format");
        if (strcmp(word, "format") == 0) format = good = read_format(ply, &line, err);
        else if (strcmp(word, "element") == 0) good = read_element(ply, &line, err);
        else if (strcmp(word, "property") == 0) good = read_property(ply, &line, err);
        else if (*word && strcmp(word, "comment") != 0 && strcmp(word, "obj_info") != 0)
            good = wr_fail(err, "is damaged: its header has the line \"%s ...\"", word);
        if (!good) return false;
    }
    return wr_fail(err, "is truncated: its header has no end_header");
}

/* ---- values ---- */

static size_t left_of(const Ply *ply)
{
    return (size_t)(ply->scan.end - ply->scan.at);
}

static bool fail_end(const Ply *ply, WrError *err)
{
    return wr_fail(err, "is truncated: it ends in %s %lld of %lld", ply->element->name,
                   (long long)ply->entry, (long long)ply->element->count);
}

/* Bytes are assembled most significant first, so that the host's byte order does not matter; the shift of `bits` sign-extends
   by the conversion to a signed type of its size. */
static double binary_value(const Ply *ply, Type type)
{
    unsigned char b[8];
    const int n = types[type].bytes;
    const unsigned char *at = (const unsigned char *)ply->scan.at;
    uint64_t bits = 0;
    for (int i = 0; i < n; i++) b[i] = at[ply->big ? i : n - 1 - i];
    for (int i = 0; i < n; i++) bits = bits << 8 | b[i];
    const uint32_t half = (uint32_t)bits;
    float single;
    double value;
    switch (type) {
    case CHAR: return (int8_t)bits;
    case SHORT: return (int16_t)bits;
    case INT: return (int32_t)half;
    case FLOAT: memcpy(&single, &half, sizeof single); return (double)single;
    case DOUBLE: memcpy(&value, &bits, sizeof value); return value;
    default: return (double)bits;
    }
}

static bool take_value(Ply *ply, Type type, double *out, WrError *err)
{
    if (ply->text) {
        scan_space(&ply->scan);
        const char *from = ply->scan.at;
        if (left_of(ply) == 0) return fail_end(ply, err);
        if (scan_any_number(&ply->scan, out)) return true;
        return wr_fail(err, "is damaged: %s %lld: \"%.*s\" is not a number", ply->element->name,
                       (long long)ply->entry,
                       (int)(ply->scan.at - from < 40 ? ply->scan.at - from : 40), from);
    }
    if (left_of(ply) < (size_t)types[type].bytes) return fail_end(ply, err);
    *out = binary_value(ply, type);
    ply->scan.at += types[type].bytes;
    return true;
}

/* Reads a list's length; the remaining bytes must be able to contain the list. Otherwise a header of a few bytes could
   request gigabytes (untrusted file). */
static bool take_length(Ply *ply, const Property *property, size_t *out, WrError *err)
{
    double count = 0;
    if (!take_value(ply, property->count, &count, err)) return false;
    const double least = ply->text ? 2 : types[property->type].bytes; /* a digit and a blank */
    if (!(count >= 0) || count > floor(count) ||
        (count - (ply->text ? 1 : 0)) * least > (double)left_of(ply))
        return wr_fail(err, "is damaged: %s %lld has a list of %g numbers, with %zu bytes left",
                       ply->element->name, (long long)ply->entry, count, left_of(ply));
    *out = (size_t)count;
    return true;
}

static bool list_room(Ply *ply, List *list, size_t count, WrError *err)
{
    list->count = 0;
    if (count <= list->room) return true;
    wr_free(list->at);
    list->room = 0;
    list->at = wr_try_alloc_unset(2 * count, sizeof *list->at, "a mesh", err);
    if (!list->at) {
        ply->build->memory = true;
        return false;
    }
    list->room = 2 * count;
    return true;
}

static bool take_list(Ply *ply, const Property *property, WrError *err)
{
    size_t count = 0;
    double unused;
    if (!take_length(ply, property, &count, err)) return false;
    List *list = property->role == CORNERS    ? &ply->corners
                 : property->role == TEXCOORD ? &ply->texcoord
                                              : NULL;
    if (list && !list_room(ply, list, count, err)) return false;
    for (size_t i = 0; i < count; i++)
        if (!take_value(ply, property->type, list ? &list->at[i] : &unused, err)) return false;
    if (list) list->count = count;
    return true;
}

static bool take_entry(Ply *ply, WrError *err)
{
    double value;
    const Property *property = ply->properties + ply->element->first;
    ply->corners.count = ply->texcoord.count = 0;
    for (int i = 0; i < ply->element->properties; i++, property++) {
        if (property->list) {
            if (!take_list(ply, property, err)) return false;
        } else {
            if (!take_value(ply, property->type, &value, err)) return false;
            if (property->role < VALUES) ply->values[property->role] = value;
        }
    }
    return true;
}

/* ---- elements ---- */

static bool add_vertex(Ply *ply, WrError *err)
{
    const double *v = ply->values;
    const float n[3] = { (float)v[NX], (float)v[NY], (float)v[NZ] };
    const float uv[2] = { (float)v[U], (float)v[V] };
    const bool normal = ply->used[NX] && ply->used[NY] && ply->used[NZ];
    return wr_mesh_build_point(ply->places, v, normal ? n : NULL,
                               ply->used[U] && ply->used[V] ? uv : NULL, err);
}

static bool check_corner(const Ply *ply, double index, WrError *err)
{
    if (index >= 0 && index < ply->vertices && !(index > floor(index))) return true;
    return wr_fail(err, "is damaged: %s %lld refers to vertex %g: must be 0..%d",
                   ply->element->name, (long long)ply->entry, index, (int)ply->vertices - 1);
}

static bool polygon_room(Ply *ply, size_t count, WrError *err)
{
    if (count <= ply->polygon_room) return true;
    wr_free(ply->polygon);
    ply->polygon_room = 0;
    ply->polygon = wr_try_alloc_unset(2 * count, sizeof *ply->polygon, "a mesh", err);
    if (!ply->polygon) {
        ply->build->memory = true;
        return false;
    }
    ply->polygon_room = 2 * count;
    return true;
}

/* The mesh point of corner i of the present face: the vertex, with the face's own (u,v) if it has some. */
static bool find_corner(Ply *ply, size_t i, int32_t *out, WrError *err)
{
    if (!check_corner(ply, ply->corners.at[i], err)) return false;
    const int32_t vertex = (int32_t)ply->corners.at[i];
    const WrMeshBuild *places = ply->places;
    const bool own = ply->texcoord.count == 2 * ply->corners.count;
    const float own_uv[2] = { own ? (float)ply->texcoord.at[2 * i] : 0,
                              own ? (float)ply->texcoord.at[2 * i + 1] : 0 };
    const float *uv = own ? own_uv : NULL;
    if (!uv && places->whole && !isnan(places->uv[vertex][0])) uv = places->uv[vertex];
    *out = wr_mesh_build_wedge(ply->build, &ply->first[vertex], places->points[vertex],
                               places->whole ? places->normals[vertex] : NULL, uv, err);
    return *out >= 0;
}

static bool add_face(Ply *ply, WrError *err)
{
    const size_t count = ply->corners.count;
    if (count < 3) return true;
    if (!polygon_room(ply, count, err)) return false;
    for (size_t i = 0; i < count; i++)
        if (!find_corner(ply, i, &ply->polygon[i], err)) return false;
    return wr_mesh_build_polygon(ply->build, ply->polygon, (int32_t)count, err);
}

/* Strips are lists separated by -1. */
static bool add_strips(Ply *ply, WrError *err)
{
    const size_t count = ply->corners.count;
    int32_t length = 0;
    if (!polygon_room(ply, count, err)) return false;
    for (size_t i = 0; i <= count; i++) {
        if (i < count && ply->corners.at[i] >= 0) {
            if (!find_corner(ply, i, &ply->polygon[length++], err)) return false;
            continue;
        }
        if (!wr_mesh_build_strip(ply->build, ply->polygon, length, err)) return false;
        length = 0;
    }
    return true;
}

typedef bool Add(Ply *ply, WrError *err);

static bool pass_over(Ply *ply, WrError *err)
{
    (void)ply;
    (void)err;
    return true;
}

static const struct {
    const char *element;
    Add *add;
} adders[] = { { "vertex", add_vertex }, { "face", add_face }, { "tristrips", add_strips } };

static Add *adder_of(const char *element)
{
    for (size_t i = 0; i < sizeof adders / sizeof *adders; i++)
        if (strcmp(element, adders[i].element) == 0) return adders[i].add;
    return pass_over;
}

static bool begin_element(Ply *ply, Add *add, WrError *err)
{
    const Element *element = ply->element;
    memset(ply->used, 0, sizeof ply->used);
    memset(ply->values, 0, sizeof ply->values);
    for (int i = 0; i < element->properties; i++) {
        const Role role = ply->properties[element->first + i].role;
        if (role < UNUSED) ply->used[role] = true;
    }
    if (add == add_vertex && ply->first)
        return wr_fail(err, "is damaged: its header has the element vertex twice");
    if (add == add_vertex && element->count > 0 && !(ply->used[X] && ply->used[Y] && ply->used[Z]))
        return wr_fail(err, "its vertices have no x, y and z");
    if (add != add_vertex && add != pass_over && element->count > 0 && !ply->first)
        return wr_fail(err, "is damaged: the element %s is before the vertices", element->name);
    return true;
}

/* Wedges of faces become points of `build`; allocates one chain for each vertex. */
static bool end_vertices(Ply *ply, WrError *err)
{
    ply->vertices = ply->places->point_count;
    ply->first = wr_try_alloc((size_t)ply->vertices + 1, sizeof *ply->first, "a mesh", err);
    ply->build->memory |= !ply->first;
    return ply->first && wr_mesh_build_reserve(ply->build, ply->vertices, 0, err);
}

static bool read_entries(Ply *ply, const Element *element, WrError *err)
{
    Add *add = adder_of(element->name);
    ply->element = element;
    if (!begin_element(ply, add, err)) return false;
    const int64_t count = element->properties > 0 ? element->count : 0;
    for (ply->entry = 1; ply->entry <= count; ply->entry++)
        if (!take_entry(ply, err) || !add(ply, err)) return false;
    return add != add_vertex || end_vertices(ply, err);
}

/* Every entry has at least one byte. */
static bool check_counts(const Ply *ply, WrError *err)
{
    for (int i = 0; i < ply->element_count; i++)
        if ((double)ply->elements[i].count > (double)left_of(ply))
            return wr_fail(err,
                           "is damaged: its header has %lld elements, but the file only %zu bytes",
                           (long long)ply->elements[i].count, left_of(ply));
    return true;
}

bool wr_ply_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    WrMeshBuild places = { .whole = build->whole };
    Ply *ply = wr_alloc(1, sizeof *ply);
    ply->scan = (WrScan){ bytes, bytes + length };
    ply->build = build;
    ply->places = &places;
    bool good =
        wr_ply_is(bytes, length) || wr_fail(err, "is not a PLY file, which begins with \"ply\"");
    good = good && read_header(ply, err) && check_counts(ply, err);
    for (int i = 0; good && i < ply->element_count; i++)
        good = read_entries(ply, &ply->elements[i], err);
    build->memory |= places.memory;
    if (build->bad_uv == 0) memcpy(build->bad_uv_at, places.bad_uv_at, sizeof build->bad_uv_at);
    build->bad_uv += places.bad_uv;
    wr_mesh_build_fini(&places);
    wr_free(ply->corners.at);
    wr_free(ply->texcoord.at);
    wr_free(ply->first);
    wr_free(ply->polygon);
    wr_free(ply);
    return good;
}

/* ---- STL ---- */

#define HEAD 84              /* bytes: a title of 80, the number of triangles */
#define RECORD 50            /* bytes: a normal, three points, two unused bytes */
#define FACET_CORNERS_MAX 64 /* corners of an ASCII facet; the format has 3 */

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

/* Three points each. */
static bool check_count(int64_t count, WrError *err)
{
    return count <= WR_MESH_POINTS_MAX / 3 ||
           wr_fail(err,
                   "has more than %d triangles, the most of an STL file: PLY, OBJ and glTF files, "
                   "whose triangles share points, may have %d",
                   WR_MESH_POINTS_MAX / 3, WR_MESH_TRIANGLES_MAX);
}

static bool read_binary(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    if (length < HEAD)
        return wr_fail(err, "is truncated: %zu bytes, but an STL file has at least %d", length,
                       HEAD);
    const uint32_t count = number_at(bytes + 80);
    if (count > (length - HEAD) / RECORD)
        return wr_fail(
            err,
            "is damaged or truncated: its header has %u triangles, but the file only %zu bytes",
            (unsigned)count, length - HEAD);
    if (!check_count(count, err) || !wr_mesh_build_reserve(build, 3 * (int64_t)count, count, err))
        return false;
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
    int32_t corners[FACET_CORNERS_MAX];
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
        scan_space(&stl->scan);
        const char *from = stl->scan.at;
        if (from == stl->scan.end)
            return wr_fail(err, "is truncated in facet %lld", (long long)stl->facet);
        if (scan_any_number(&stl->scan, &out[k])) continue;
        const size_t length = (size_t)(stl->scan.at - from);
        return wr_fail(err, "is damaged: facet %lld: %s: \"%.*s\" is not a number",
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
    scan_space(&stl->scan);
    const WrScan before = stl->scan;
    const size_t length = scan_word(&stl->scan, &word);
    if (!is_word(word, length, "normal")) {
        stl->scan = before; /* a facet without a normal */
        return true;
    }
    if (!take_three(stl, "normal", n, err)) return false;
    for (int k = 0; k < 3; k++) stl->normal[k] = (float)n[k];
    return true;
}

static bool add_facet_corner(Stl *stl, WrError *err)
{
    double p[3];
    if (stl->facet == 0) return wr_fail(err, "is damaged: it has a vertex before any facet");
    if (!take_three(stl, "vertex", p, err)) return false;
    if (stl->count == FACET_CORNERS_MAX)
        return wr_fail(err, "is damaged: facet %lld has more than %d corners",
                       (long long)stl->facet, FACET_CORNERS_MAX);
    stl->corners[stl->count++] = stl->build->point_count;
    return wr_mesh_build_point(stl->build, p, stl->normal, NULL, err);
}

static bool end_facet(Stl *stl, WrError *err)
{
    if (stl->count < 3)
        return wr_fail(err, "is damaged: facet %lld has %d corners: must be 3",
                       (long long)stl->facet, (int)stl->count);
    const bool good = check_count((int64_t)stl->build->triangle_count + 1, err) &&
                      wr_mesh_build_polygon(stl->build, stl->corners, stl->count, err);
    stl->count = 0;
    return good;
}

/* The rest of the line is the name of the solid. */
static void begin_solid(Stl *stl)
{
    const char *from, *to;
    scan_blanks(&stl->scan);
    from = to = stl->scan.at;
    for (; stl->scan.at < stl->scan.end && (unsigned char)*stl->scan.at != '\n'; stl->scan.at++)
        if ((unsigned char)*stl->scan.at > ' ') to = stl->scan.at + 1;
    wr_mesh_build_part(stl->build, from, (size_t)(to - from));
}

static bool take_stl_word(Stl *stl, const char *word, size_t length, WrError *err)
{
    if (is_word(word, length, "vertex")) return add_facet_corner(stl, err);
    if (is_word(word, length, "facet")) return begin_facet(stl, err);
    if (is_word(word, length, "endfacet")) return end_facet(stl, err);
    if (is_word(word, length, "solid") || is_word(word, length, "endsolid")) begin_solid(stl);
    else if (!is_word(word, length, "outer") && !is_word(word, length, "loop") &&
             !is_word(word, length, "endloop"))
        return wr_fail(err, "is damaged: facet %lld is followed by \"%.*s\"", (long long)stl->facet,
                       (int)(length < 40 ? length : 40), word);
    return true;
}

static bool read_text(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    Stl stl = { .scan = { bytes, bytes + length }, .build = build };
    const char *word;
    size_t n;
    for (scan_space(&stl.scan); (n = scan_word(&stl.scan, &word)) > 0; scan_space(&stl.scan))
        if (!take_stl_word(&stl, word, n, err)) return false;
    return stl.count == 0 || wr_fail(err, "is truncated in facet %lld", (long long)stl.facet);
}

bool wr_stl_is_binary(const char *bytes, size_t length)
{
    return length >= HEAD && HEAD + RECORD * (uint64_t)number_at(bytes + 80) == length;
}

/* Titles of binary files may also begin with "solid"; their length distinguishes them. */
static bool is_text(const char *bytes, size_t length)
{
    WrScan scan = { bytes, bytes + length };
    const char *word;
    if (wr_stl_is_binary(bytes, length)) return false;
    scan_space(&scan);
    const size_t n = scan_word(&scan, &word);
    return is_word(word, n, "solid") || is_word(word, n, "facet");
}

bool wr_stl_read(const char *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    return is_text(bytes, length) ? read_text(bytes, length, build, err)
                                  : read_binary(bytes, length, build, err);
}
