/* Decoding of mesh files: the mesh under construction, and the choice of the reader. */
#include "image/mesh_decode.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/text.h"
#include "image/assimp.h"
#include "image/mesh_build.h"
#include "image/mesh_readers.h"
#include "image/module_path.h"

#include <math.h>
#include <string.h>

/* ---- the mesh under construction ---- */

/* A mesh under construction: points[i] with normals[i], uv[i], and next[i], a chain of points at the same place: 1 + the next
   one's number, 0 at the end. Arrays grow by doubling, limited by the maximum of readable meshes. */
#define ALIKE 32            /* wedges of one place that are compared; further ones are not merged */
#define UV_MAX 1e6F         /* larger ones are treated as missing (surface/triangles.h) */
#define WORK_MAX 2000000000 /* steps: a few seconds */
/* A mesh whose distance from the origin is this many times its size loses at least 2 of 24 bits; a
   nearer one is not moved. */
#define FAR 64.0

void wr_mesh_build_fini(WrMeshBuild *build)
{
    wr_free(build->points);
    wr_free(build->normals);
    wr_free(build->uv);
    wr_free(build->next);
    wr_free(build->corners);
    wr_free(build->parts);
    *build = (WrMeshBuild){ 0 };
}

/* ---- memory ---- */

/* Reallocates *block for `room` items; keeps the first `count`. */
static bool grow(WrMeshBuild *build, void **block, size_t count, size_t room, size_t size,
                 WrError *err)
{
    void *more = wr_try_alloc_unset(room, size, "a mesh", err);
    if (!more) {
        build->memory = true;
        return false;
    }
    if (count > 0) memcpy(more, *block, count * size);
    wr_free(*block);
    *block = more;
    return true;
}

#define GROW(build, array, count, room, err)                                                       \
    grow(build, (void **)&(build)->array, (size_t)(count), room, sizeof *(build)->array, err)

static size_t doubled(size_t room, int64_t need, size_t most)
{
    const size_t twice = room < 32 ? 64 : 2 * room;
    const size_t out = twice < (size_t)need ? (size_t)need : twice;
    return out < most ? out : most;
}

static bool points_room(WrMeshBuild *build, int64_t more, WrError *err)
{
    const int64_t need = build->point_count + more;
    if (need > WR_MESH_POINTS_MAX) return wr_fail(err, "more than %d points", WR_MESH_POINTS_MAX);
    if ((size_t)need <= build->point_room) return true;
    const size_t room = doubled(build->point_room, need, WR_MESH_POINTS_MAX);
    const int32_t count = build->point_count;
    if (!GROW(build, points, count, room, err) || !GROW(build, next, count, room, err) ||
        (build->whole &&
         (!GROW(build, normals, count, room, err) || !GROW(build, uv, count, room, err))))
        return false;
    build->point_room = room;
    return true;
}

static bool triangles_room(WrMeshBuild *build, int64_t more, WrError *err)
{
    const int64_t need = build->triangle_count + more;
    if (need > WR_MESH_TRIANGLES_MAX)
        return wr_fail(err, "more than %d triangles", WR_MESH_TRIANGLES_MAX);
    if ((size_t)need <= build->triangle_room) return true;
    const size_t room = doubled(build->triangle_room, need, WR_MESH_TRIANGLES_MAX);
    if (!GROW(build, corners, build->triangle_count, room, err)) return false;
    build->triangle_room = room;
    return true;
}

bool wr_mesh_build_reserve(WrMeshBuild *build, int64_t points, int64_t triangles, WrError *err)
{
    return points_room(build, points, err) && triangles_room(build, triangles, err);
}

/* ---- points ---- */

static const float unmapped[2] = { NAN, NAN };

static bool is_bad_uv(const float *uv)
{
    return uv && !(fabsf(uv[0]) <= UV_MAX && fabsf(uv[1]) <= UV_MAX);
}

bool wr_mesh_build_point(WrMeshBuild *build, const double p[3], const float normal[3],
                         const float uv[2], WrError *err)
{
    static const float none[3] = { 0, 0, 0 };
    if (!points_room(build, 1, err)) return false;
    const int32_t i = build->point_count++;
    memcpy(build->points[i], p, sizeof build->points[i]);
    build->next[i] = 0;
    if (!build->whole) return true;
    if (is_bad_uv(uv) && build->bad_uv++ == 0) memcpy(build->bad_uv_at, p, sizeof build->bad_uv_at);
    memcpy(build->normals[i], normal ? normal : none, sizeof none);
    memcpy(build->uv[i], uv && !is_bad_uv(uv) ? uv : unmapped, sizeof unmapped);
    return true;
}

/* Compares bits, so that two missing (u,v), which are NaN, are equal. */
static bool has_looks(const WrMeshBuild *build, int32_t i, const float normal[3], const float uv[2])
{
    static const float none[3] = { 0, 0, 0 };
    if (!build->whole) return true;
    if (memcmp(build->normals[i], normal ? normal : none, sizeof none) != 0) return false;
    return uv && !is_bad_uv(uv) ? memcmp(build->uv[i], uv, 2 * sizeof *uv) == 0
                                : isnan(build->uv[i][0]) && isnan(build->uv[i][1]);
}

int32_t wr_mesh_build_wedge(WrMeshBuild *build, int32_t *first, const double p[3],
                            const float normal[3], const float uv[2], WrError *err)
{
    int32_t i = *first;
    for (int k = 0; i && k < ALIKE; k++) {
        if (has_looks(build, i - 1, normal, uv)) return i - 1;
        i = build->next[i - 1];
    }
    if (!wr_mesh_build_point(build, p, normal, uv, err)) return -1;
    build->next[build->point_count - 1] = *first;
    *first = build->point_count;
    return build->point_count - 1;
}

/* ---- triangles ---- */

void wr_mesh_build_part(WrMeshBuild *build, const char *name, size_t length)
{
    const size_t n = length < WR_MESH_NAME ? length : WR_MESH_NAME - 1;
    memset(build->part, 0, sizeof build->part);
    memcpy(build->part, name, n);
}

/* Adjacent triangles of one name form one part; beyond the maximum number of parts, all that follow
 * form the last one. */
static bool count_in_part(WrMeshBuild *build, WrError *err)
{
    const int32_t count = build->part_count;
    if (!build->parts && !GROW(build, parts, 0, WR_MESH_PARTS_MAX, err)) return false;
    if (count < WR_MESH_PARTS_MAX &&
        (count == 0 || strcmp(build->parts[count - 1].name, build->part) != 0)) {
        WrMeshPart *part = &build->parts[build->part_count++];
        *part = (WrMeshPart){ .first = build->triangle_count };
        memcpy(part->name, build->part, sizeof part->name);
    }
    build->parts[build->part_count - 1].count++;
    return true;
}

bool wr_mesh_build_triangle(WrMeshBuild *build, int32_t a, int32_t b, int32_t c, WrError *err)
{
    if (!triangles_room(build, 1, err) || (build->whole && !count_in_part(build, err)))
        return false;
    int32_t *to = build->corners[build->triangle_count++];
    to[0] = a, to[1] = b, to[2] = c;
    return true;
}

bool wr_mesh_build_strip(WrMeshBuild *build, const int32_t *corners, int32_t count, WrError *err)
{
    for (int32_t i = 0; i + 2 < count; i++) {
        const int32_t a = corners[i], b = corners[i + 1 + i % 2], c = corners[i + 2 - i % 2];
        if (a == b || b == c || c == a) continue;
        if (!wr_mesh_build_triangle(build, a, b, c, err)) return false;
    }
    return true;
}

/* ---- polygons ---- */

/* Cosine of the angle at `at`; 0 if an edge has no length. */
static double cosine(const double *at, const double *a, const double *b)
{
    double ab = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; k++) {
        const double u = a[k] - at[k], w = b[k] - at[k];
        ab += u * w, aa += u * u, bb += w * w;
    }
    return aa * bb > 0 ? ab / sqrt(aa * bb) : 0;
}

/* The corner whose diagonal splits a quadrilateral: the reflex one, if any, where the two angles beside
   the diagonal have a + b > pi, thus cos a + cos b < 0. */
static int32_t dent_of(const WrMeshBuild *build, const int32_t *c)
{
    for (int32_t i = 0; i < 4; i++) {
        const double *at = build->points[c[i]], *across = build->points[c[(i + 2) % 4]];
        if (cosine(at, build->points[c[(i + 1) % 4]], across) +
                cosine(at, build->points[c[(i + 3) % 4]], across) <
            -1e-6)
            return i;
    }
    return 0;
}

static bool add_fan(WrMeshBuild *build, const int32_t *c, int32_t count, int32_t from, WrError *err)
{
    for (int32_t i = 1; i < count - 1; i++)
        if (!wr_mesh_build_triangle(build, c[from], c[(from + i) % count],
                                    c[(from + i + 1) % count], err))
            return false;
    return true;
}

/* A polygon projected along its mean normal, counter-clockwise. */
typedef struct Flat {
    double x, y;
} Flat;

static double turn(Flat a, Flat b, Flat c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Newell's normal: the sum of the cross products of adjacent corners, relative to the first corner;
   then projection to the two axes perpendicular to its largest component. */
static void flatten(const WrMeshBuild *build, const int32_t *c, int32_t count, Flat *out)
{
    double n[3] = { 0, 0, 0 };
    const double *at = build->points[c[0]];
    for (int32_t i = 1; i + 1 < count; i++) {
        const double *p = build->points[c[i]], *q = build->points[c[i + 1]];
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            n[k] += (p[a] - at[a]) * (q[b] - at[b]) - (p[b] - at[b]) * (q[a] - at[a]);
        }
    }
    int axis = fabs(n[1]) > fabs(n[0]) ? 1 : 0;
    if (fabs(n[2]) > fabs(n[axis])) axis = 2;
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    for (int32_t i = 0; i < count; i++) {
        const double *p = build->points[c[i]];
        out[i].x = p[x] - at[x];
        out[i].y = n[axis] < 0 ? at[y] - p[y] : p[y] - at[y];
    }
}

static bool is_convex(const Flat *p, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (turn(p[i], p[(i + 1) % count], p[(i + 2) % count]) < 0) return false;
    return true;
}

static bool same(Flat a, Flat b)
{
    return !(a.x < b.x) && !(a.x > b.x) && !(a.y < b.y) && !(a.y > b.y);
}

/* Corner i of those left is an ear if it turns left and no other corner lies in its triangle. */
static bool is_ear(WrMeshBuild *build, const Flat *p, const int32_t *left, int32_t count, int32_t i)
{
    const int32_t before = (i + count - 1) % count, after = (i + 1) % count;
    const Flat a = p[left[before]], b = p[left[i]], c = p[left[after]];
    build->work += count;
    if (!(turn(a, b, c) > 0)) return false;
    for (int32_t k = 0; k < count; k++) {
        const Flat q = p[left[k]];
        if (k == before || k == i || k == after || same(q, a) || same(q, b) || same(q, c)) continue;
        if (turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0) return false;
    }
    return true;
}

/* Cuts off ears one by one. If there is none, as in self-intersecting polygons, any corner is cut. */
static bool clip_ears(WrMeshBuild *build, const int32_t *c, const Flat *p, int32_t *left,
                      int32_t count, WrError *err)
{
    for (int32_t i = 0; i < count; i++) left[i] = i;
    for (int32_t n = count, i = 0, tried = 0; n >= 3;) {
        if (build->work > WORK_MAX)
            return wr_fail(err,
                           "a concave polygon of %d corners would take too long to triangulate; "
                           "save triangles",
                           (int)count);
        if (n > 3 && tried < n && !is_ear(build, p, left, n, i)) {
            tried++;
            i = (i + 1) % n;
            continue;
        }
        if (!wr_mesh_build_triangle(build, c[left[(i + n - 1) % n]], c[left[i]],
                                    c[left[(i + 1) % n]], err))
            return false;
        memmove(left + i, left + i + 1, (size_t)(n - i - 1) * sizeof *left);
        n--;
        tried = 0;
        i = i < n ? i : 0;
    }
    return true;
}

static bool add_dented(WrMeshBuild *build, const int32_t *c, int32_t count, WrError *err)
{
    Flat *flat = wr_try_alloc_unset((size_t)count, sizeof *flat, "a polygon", err);
    int32_t *left = wr_try_alloc_unset((size_t)count, sizeof *left, "a polygon", err);
    bool good = flat && left;
    build->memory |= !good;
    if (good) {
        flatten(build, c, count, flat);
        good = is_convex(flat, count) ? add_fan(build, c, count, 0, err)
                                      : clip_ears(build, c, flat, left, count, err);
    }
    wr_free(flat);
    wr_free(left);
    return good;
}

bool wr_mesh_build_polygon(WrMeshBuild *build, const int32_t *corners, int32_t count, WrError *err)
{
    if (count < 3) return true;
    if (count == 3) return add_fan(build, corners, count, 0, err);
    if (count == 4) return add_fan(build, corners, count, dent_of(build, corners), err);
    return add_dented(build, corners, count, err);
}

/* ---- the end ---- */

static bool check_points(const WrMeshBuild *build, WrError *err)
{
    for (int32_t i = 0; i < build->point_count; i++) {
        const double *p = build->points[i];
        if (fabs(p[0]) <= 1e30 && fabs(p[1]) <= 1e30 && fabs(p[2]) <= 1e30) continue;
        return wr_fail(err, "point %d is %g,%g,%g: coordinates are numbers from -1e30 to 1e30",
                       (int)i + 1, p[0], p[1], p[2]);
    }
    return true;
}

/* 0 for a mesh near the origin; else the lowest corner of its bounding box, rounded to integers where
 * the size allows. */
static void find_origin(const WrMeshBuild *build, double origin[3])
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    double size = 0, away = 0;
    for (int32_t i = 0; i < 3 * build->triangle_count; i++) {
        const double *p = build->points[build->corners[i / 3][i % 3]];
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], p[k]);
            high[k] = fmax(high[k], p[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        size = fmax(size, high[k] - low[k]);
        away = fmax(away, fmax(fabs(low[k]), fabs(high[k])));
    }
    const bool is_far = away > FAR * size;
    for (int k = 0; k < 3; k++) origin[k] = !is_far ? 0 : size >= 1 ? floor(low[k]) : low[k];
}

static void add(WrText *block, const void *from, size_t bytes)
{
    wr_text_add_n(block, from, bytes);
}

/* Serialises the mesh (mesh_decode.h) and appends it. Errors: no triangle; a point that is not finite
 * or beyond 1e30 (the first is named). */
static bool mesh_build_finish(const WrMeshBuild *build, WrText *block, WrError *err)
{
    const size_t points = (size_t)build->point_count, triangles = (size_t)build->triangle_count;
    if (!check_points(build, err)) return false;
    if (triangles == 0) return wr_fail(err, "contains no triangle");
    WrMeshHead head = { .points = build->point_count,
                        .triangles = build->triangle_count,
                        .whole = build->whole,
                        .single = build->single,
                        .unit = (int32_t)build->unit,
                        .bad_uv = build->bad_uv,
                        .parts = build->whole ? build->part_count : 0 };
    memcpy(head.bad_uv_at, build->bad_uv_at, sizeof head.bad_uv_at);
    find_origin(build, head.origin);
    add(block, &head, sizeof head);
    for (size_t i = 0; i < points; i++) {
        float p[3];
        for (int k = 0; k < 3; k++) p[k] = (float)(build->points[i][k] - head.origin[k]);
        add(block, p, sizeof p);
    }
    add(block, build->corners, triangles * sizeof *build->corners);
    if (!build->whole) return true;
    add(block, build->normals, points * sizeof *build->normals);
    add(block, build->uv, points * sizeof *build->uv);
    add(block, build->parts, (size_t)build->part_count * sizeof *build->parts);
    return true;
}

/* ---- the choice of the reader ---- */

static const WrAssimpTable *library(WrError *err)
{
    static WrModule module = { .file = "wrinkle_assimp.so",
                               .serves = "mesh files",
                               .package = WR_ASSIMP_PACKAGE,
                               .symbol = WR_ASSIMP_SYMBOL,
                               .version = WR_ASSIMP_VERSION,
                               .loading = { .work = wr_module_load, .ctx = &module } };
    return wr_module_table(&module, err);
}

bool wr_mesh_load(WrError *err)
{
    return library(err) != NULL;
}

/* ---- reading by the library ---- */

static bool take_points(const WrAssimpTable *table, const WrAssimpMesh *mesh, WrMeshBuild *build,
                        WrError *err)
{
    const int32_t count = table->points(mesh);
    build->single = true;
    const double *points = table->point_data(mesh);
    const float *looks = table->look_data(mesh); /* a normal and (u,v) of each point; NaN: none */
    if (!wr_mesh_build_reserve(build, count, table->triangles(mesh), err)) return false;
    for (int32_t i = 0; i < count; i++) {
        const float *look = build->whole ? looks + 5 * (size_t)i : NULL;
        const float *uv = look && !(isnan(look[3]) && isnan(look[4])) ? look + 3 : NULL;
        if (!wr_mesh_build_point(build, points + 3 * (size_t)i, look, uv, err)) return false;
    }
    return true;
}

static bool take_triangles(const WrAssimpTable *table, const WrAssimpMesh *mesh, WrMeshBuild *build,
                           WrError *err)
{
    const int32_t count = table->triangles(mesh), parts = table->parts(mesh);
    const int32_t *corner = table->corner_data(mesh);
    for (int32_t i = 0, part = 0; i < count; i++, corner += 3) {
        const char *name;
        for (; part < parts && table->part(mesh, part, &name) <= i; part++)
            wr_mesh_build_part(build, name, strlen(name));
        if (!wr_mesh_build_triangle(build, corner[0], corner[1], corner[2], err)) return false;
    }
    return true;
}

static bool read_by_library(const void *bytes, size_t length, const char *ending,
                            WrMeshBuild *build, WrError *err)
{
    char reason[WR_ASSIMP_REASON] = "";
    const WrAssimpTable *table = library(err);
    if (!table) return false;
    WrAssimpMesh *mesh = table->read(bytes, length, ending, WR_MESH_POINTS_MAX,
                                     WR_MESH_TRIANGLES_MAX, build->whole, reason);
    if (!mesh) {
        build->memory = strcmp(reason, WR_ASSIMP_NO_MEMORY) == 0;
        return wr_fail(err, "%s", reason);
    }
    const bool good =
        take_points(table, mesh, build, err) && take_triangles(table, mesh, build, err);
    table->close(mesh);
    return good;
}

/* ---- the content of files that could not be read ---- */

#define TEXT_LOOKED 512 /* bytes */

/* Plain text, perhaps with lines of an OBJ file: "v 1 2 3". NULL: something else. */
static const char *text_of(const char *bytes, size_t length)
{
    bool vertex = false, begins = true;
    for (size_t i = 0; i < length && i < TEXT_LOOKED; i++) {
        if ((unsigned char)bytes[i] < ' ' && !memchr("\t\n\r\f", bytes[i], 4)) return NULL;
        vertex |= begins && i + 1 < length && memcmp(bytes + i, "v ", 2) == 0;
        begins = bytes[i] == '\n';
    }
    return vertex ? WR_MESSAGE("an OBJ file") : WR_MESSAGE("plain text");
}

/* The content by its first bytes; NULL: that of the ending, or unknown. Text is recognised only in the place of
   formats that the own readers read: others may be text too. */
static const char *content_of(const void *bytes, size_t length, const char *ending)
{
    static const struct {
        const char *begins;
        size_t count;
        const char *name, *endings;
    } kinds[] = {
        { "\x89PNG", 4, WR_MESSAGE("a PNG picture"), "png" },
        { "\xff\xd8\xff", 3, WR_MESSAGE("a JPEG picture"), "jpg jpeg" },
        { "GIF8", 4, WR_MESSAGE("a GIF picture"), "gif" },
        { "II*\0", 4, WR_MESSAGE("a TIFF picture"), "tif tiff" },
        { "MM\0*", 4, WR_MESSAGE("a TIFF picture"), "tif tiff" },
        { "v/1\1", 4, WR_MESSAGE("an OpenEXR picture"), "exr" },
        { "%PDF", 4, WR_MESSAGE("a PDF document"), "pdf" },
        { "PK\3\4", 4, WR_MESSAGE("a zip archive, such as 3MF"), "3mf" },
        { "BLENDER", 7, WR_MESSAGE("a Blender file"), "blend" },
        { "glTF", 4, WR_MESSAGE("a binary glTF file"), "glb gltf" },
        { "solid", 5, WR_MESSAGE("an STL file"), "stl" },
    };
    if (wr_ply_is(bytes, length)) return NULL; /* it was read as such, whatever its name */
    for (int i = 0; i < WR_LENGTH(kinds); i++)
        if (length >= kinds[i].count && memcmp(bytes, kinds[i].begins, kinds[i].count) == 0)
            return strstr(kinds[i].endings, ending) ? NULL : kinds[i].name;
    if (wr_stl_is_binary(bytes, length))
        return strcmp(ending, "stl") == 0 ? NULL : WR_MESSAGE("an STL file");
    const bool own = strcmp(ending, "stl") == 0 || strcmp(ending, "ply") == 0;
    const char *text = own || strcmp(ending, "obj") == 0 ? text_of(bytes, length) : NULL;
    return text && (own || strcmp(text, WR_MESSAGE("plain text")) == 0) ? text : NULL;
}

/* Replaces the error by one that names the content, if that is of another kind than the file's name says. */
static void explain_content(const void *bytes, size_t length, const char *ending, WrError *err)
{
    const char *content = *ending ? content_of(bytes, length, ending) : NULL;
    char name[16];
    int i = 0;
    for (; ending[i] && i + 1 < WR_LENGTH(name); i++)
        name[i] = (char)(ending[i] >= 'a' && ending[i] <= 'z' ? ending[i] - 'a' + 'A' : ending[i]);
    name[i] = '\0';
    if (content) wr_fail(err, "is not a valid %s file: its content is %s", name, content);
}

/* ---- all formats ---- */

/* The format by the bytes if they are characteristic, else by the extension; formats without an own
 * reader use the library. */
static bool read_kind(const void *bytes, size_t length, const char *ending, WrMeshBuild *build,
                      WrError *err)
{
    if (wr_ply_is(bytes, length) || strcmp(ending, "ply") == 0)
        return wr_ply_read(bytes, length, build, err);
    if (strcmp(ending, "stl") == 0) return wr_stl_read(bytes, length, build, err);
    if (strcmp(ending, "gltf") == 0 || strcmp(ending, "glb") == 0)
        return wr_gltf_is(bytes, length) ? wr_gltf_read(bytes, length, build, err)
                                         : read_by_library(bytes, length, ending, build, NULL) ||
                                               wr_fail(err, "is damaged, or glTF 1.0, which is not "
                                                            "read: save it as glTF 2.0");
    if (!*ending || strcmp(ending, "obj") == 0) {
        WrError wrong = { "" };
        if (wr_obj_read(bytes, length, build, &wrong)) return true;
        if (*wrong.text) return wr_fail(err, "%s", wr_error_message(&wrong));
        const bool whole = build->whole;
        wr_mesh_build_fini(build);
        build->whole = whole;
    }
    if (strcmp(ending, "3mf") == 0 && !wr_3mf_open(bytes, length, build, err)) return false;
    return read_by_library(bytes, length, ending, build, err);
}

bool wr_mesh_make(const void *bytes, size_t length, const char *ending, bool whole, WrText *block,
                  bool *memory, WrError *err)
{
    WrMeshBuild build = { .whole = whole };
    const bool good =
        read_kind(bytes, length, ending, &build, err) && mesh_build_finish(&build, block, err);
    if (!good && !build.memory && build.point_count == 0)
        explain_content(bytes, length, ending, err);
    if (memory) *memory = !good && build.memory;
    wr_mesh_build_fini(&build);
    return good;
}
