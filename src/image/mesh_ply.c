#include "image/mesh_ply.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/mesh_build.h"
#include "image/scan.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define ELEMENTS 32
#define PROPERTIES 256 /* of all elements together */
#define NAME 64

/* ---- types and roles ---- */

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
    wr_scan_space(line);
    const size_t length = wr_scan_word(line, &word);
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
    return wr_fail(err, "is cut off: its header has no end_header");
}

/* ---- values ---- */

static size_t left_of(const Ply *ply)
{
    return (size_t)(ply->scan.end - ply->scan.at);
}

static bool fail_end(const Ply *ply, WrError *err)
{
    return wr_fail(err, "is cut off: it ends in %s %lld of %lld", ply->element->name,
                   (long long)ply->entry, (long long)ply->element->count);
}

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
        wr_scan_space(&ply->scan);
        const char *from = ply->scan.at;
        if (left_of(ply) == 0) return fail_end(ply, err);
        if (wr_scan_any_number(&ply->scan, out)) return true;
        return wr_fail(err, "is damaged: %s %lld has \"%.*s\" for a number", ply->element->name,
                       (long long)ply->entry,
                       (int)(ply->scan.at - from < 40 ? ply->scan.at - from : 40), from);
    }
    if (left_of(ply) < (size_t)types[type].bytes) return fail_end(ply, err);
    *out = binary_value(ply, type);
    ply->scan.at += types[type].bytes;
    return true;
}

/* Reads a list's length; the remaining bytes must be able to contain the list. */
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
    return wr_fail(err, "is damaged: %s %lld names vertex %g: must be 0..%d", ply->element->name,
                   (long long)ply->entry, index, (int)ply->vertices - 1);
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
    *out = wr_mesh_build_wedge(ply->build, &ply->first[vertex], places->points[vertex],
                               places->whole ? places->normals[vertex] : NULL,
                               own             ? own_uv
                               : places->whole ? places->uv[vertex]
                                               : NULL,
                               err);
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
        return wr_fail(err, "is damaged: its header names the element vertex twice");
    if (add == add_vertex && element->count > 0 && !(ply->used[X] && ply->used[Y] && ply->used[Z]))
        return wr_fail(err, "its vertices have no x, y and z");
    if (add != add_vertex && add != pass_over && element->count > 0 && !ply->first)
        return wr_fail(err, "is damaged: the element %s stands before the vertices", element->name);
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
            return wr_fail(err, "says that it holds %lld elements in %zu bytes; it is damaged",
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
    bool good = wr_ply_is(bytes, length) ||
                wr_fail(err, "cannot be read: it is no PLY file, which begins with \"ply\"");
    good = good && read_header(ply, err) && check_counts(ply, err);
    for (int i = 0; good && i < ply->element_count; i++)
        good = read_entries(ply, &ply->elements[i], err);
    build->memory |= places.memory;
    wr_mesh_build_fini(&places);
    wr_free(ply->corners.at);
    wr_free(ply->texcoord.at);
    wr_free(ply->first);
    wr_free(ply->polygon);
    wr_free(ply);
    return good;
}
