/* glTF 2.0 models in one binary file: the object at hand with maps of its relief and its material (glb), or with its relief
   as geometry (gltf).
   Source: glTF 2.0 specification: 3.6 (buffers), 3.7 (meshes), 3.9 (materials), 4 (GLB); KHR_texture_transform. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "export/gltf_model.h"
#include "export/job.h"
#include "export/preview.h"
#include "export/solid_body.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;

typedef struct WrModel {
    float (*points)[3],
        (*normals)[3];        /* [point_count], scene units, stretched as the object is; owned */
    float (*uv)[2];           /* [point_count], v upwards; owned */
    uint32_t (*triangles)[3]; /* [triangle_count], counter-clockwise from outside; owned */
    int32_t point_count, triangle_count;
    bool mapped; /* has (u,v) */
    bool raised; /* the relief is in the points: no normal map; metres */
    double per_u,
        per_v; /* mean lengths of Pu and Pv over the surface, scene units; 1 for held triangles */
} WrModel;

static void model_fini(WrModel *model);

/* ---- model ---- */

#define STEPS 64   /* squares along u and along v of a curved face */
#define CORNERS 64 /* rows where Pv jumps, at most */
#define LINES (STEPS + 2 * CORNERS + 1)
#define CREASE                                                                                     \
    1e-6 /* of v: half the distance of the two rows at such a place, so that each has its own normals */

static bool reserve(WrModel *m, int32_t points, int32_t triangles, WrError *err)
{
    const size_t p = (size_t)points, t = (size_t)triangles;
    m->points = wr_try_alloc_unset(p, sizeof *m->points, "a model", err);
    m->normals = m->points ? wr_try_alloc_unset(p, sizeof *m->normals, "a model", err) : NULL;
    m->uv = m->normals ? wr_try_alloc_unset(p, sizeof *m->uv, "a model", err) : NULL;
    m->triangles = m->uv ? wr_try_alloc_unset(t, sizeof *m->triangles, "a model", err) : NULL;
    return m->triangles;
}

static WrVec3 times(WrVec3 a, WrVec3 b)
{
    return (WrVec3){ a.x * b.x, a.y * b.y, a.z * b.z };
}

static void put(float out[3], WrVec3 v)
{
    out[0] = (float)v.x, out[1] = (float)v.y, out[2] = (float)v.z;
}

/* One without area, as at a pole, is left out. */
static void add_triangle(WrModel *m, int32_t a, int32_t b, int32_t c, bool mirrored)
{
    WrVec3 p[3];
    const int32_t corner[3] = { a, mirrored ? c : b, mirrored ? b : c };
    for (int k = 0; k < 3; k++) {
        const float *at = m->points[corner[k]];
        p[k] = (WrVec3){ (double)at[0], (double)at[1], (double)at[2] };
    }
    const WrVec3 x = v3_sub(p[1], p[0]), y = v3_sub(p[2], p[0]);
    if (!(v3_len(v3_cross(x, y)) > 1e-9 * (v3_dot(x, x) + v3_dot(y, y)))) return;
    for (int k = 0; k < 3; k++) m->triangles[m->triangle_count][k] = (uint32_t)corner[k];
    m->triangle_count++;
}

/* ---- triangles that the scene holds ---- */

/* Positions are stretched per axis by s; normals by the cofactors (s_y s_z, s_z s_x, s_x s_y), the inverse transpose times
   the determinant (NUMERICS.md HC33). A mirrored object's triangles are reversed, so that they stay counter-clockwise. */
static bool take_triangles(const WrTriangles *t, WrVec3 stretch, WrVec3 cofactor, bool mirrored,
                           WrModel *m, WrError *err)
{
    if (!reserve(m, t->corner_count, t->triangle_count, err)) return false;
    for (int32_t i = 0; i < t->corner_count; i++) {
        const WrTriangleCorner *c = &t->corners[i];
        const WrVec3 p = { (double)c->p[0], (double)c->p[1], (double)c->p[2] };
        const WrVec3 n = { (double)c->n[0], (double)c->n[1], (double)c->n[2] };
        put(m->points[i], times(stretch, p));
        put(m->normals[i], v3_unit(times(cofactor, n), n));
        m->uv[i][0] = c->u, m->uv[i][1] = c->v;
    }
    m->point_count = t->corner_count;
    for (int32_t i = 0; i < t->triangle_count; i++) {
        const int32_t *c = t->triangles[i].corner;
        add_triangle(m, c[0], c[1], c[2], mirrored);
    }
    m->mapped = t->mapped;
    m->per_u = m->per_v = 1;
    return true;
}

/* ---- surfaces by formulas ---- */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The rows of a face, ascending; where Pv jumps there are two. Rows at a distance of CREASE on both sides of a jump of Pv
   have separate points with separate normals, so the edge is shaded hard instead of averaged. Regular rows that nearly
   coincide with them are dropped. */
static int lay_rows(const WrShape *shape, WrSurfaceCell cell, int steps, double rows[LINES])
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    double corners[CORNERS];
    const int jumps = info->corners ? info->corners(shape, corners, CORNERS) : 0;
    int count = 0;
    for (int j = 0; j <= steps; j++) {
        const double v = cell.v0 + (cell.v1 - cell.v0) * j / steps;
        bool near = false;
        for (int k = 0; k < jumps; k++) near |= fabs(v - corners[k]) < 2 * CREASE;
        if (!near) rows[count++] = v;
    }
    for (int k = 0; k < jumps; k++) {
        rows[count++] = corners[k] - CREASE;
        rows[count++] = corners[k] + CREASE;
    }
    qsort(rows, (size_t)count, sizeof *rows, compare);
    return count;
}

typedef struct Cut {
    const WrShape *shape;
    WrVec3 stretch, cofactor;
    bool mirrored;
    double area, per_u, per_v; /* sums over the corners, weighted by the area about them */
} Cut;

/* per_u = sum |Pu x Pv| |Pu| / sum |Pu x Pv|: the mean length of Pu over the surface's area. A normal map holds one slope per
   texel for the whole surface, although the scale |Pu| varies with the position: this is the scale that it is made with. */
static void add_point(Cut *cut, int face, double u, double v, WrModel *m)
{
    WrSurfacePoint o;
    wr_surface_at(cut->shape, face, u, v, &o);
    const WrVec3 pu = times(cut->stretch, o.pu), pv = times(cut->stretch, o.pv);
    const double area = v3_len(v3_cross(pu, pv));
    if (isfinite(area)) {
        cut->area += area;
        cut->per_u += area * v3_len(pu);
        cut->per_v += area * v3_len(pv);
    }
    put(m->points[m->point_count], times(cut->stretch, o.p));
    put(m->normals[m->point_count], v3_unit(times(cut->cofactor, o.n_unit), o.n_unit));
    m->uv[m->point_count][0] = (float)u, m->uv[m->point_count][1] = (float)v;
    m->point_count++;
}

static void cut_face(Cut *cut, int face, int steps, WrModel *m)
{
    const WrSurfaceCell cell = wr_surface_cell(cut->shape, face);
    double rows[LINES];
    const int count = lay_rows(cut->shape, cell, steps, rows);
    const int32_t first = m->point_count;
    for (int j = 0; j < count; j++)
        for (int i = 0; i <= steps; i++)
            add_point(cut, face, cell.u0 + (cell.u1 - cell.u0) * i / steps, rows[j], m);
    for (int j = 0; j + 1 < count; j++)
        for (int i = 0; i < steps; i++) {
            const int32_t a = first + j * (steps + 1) + i, b = a + 1, d = a + steps + 1, c = d + 1;
            add_triangle(m, a, b, c, cut->mirrored);
            add_triangle(m, a, c, d, cut->mirrored);
        }
}

static bool cut_surface(const WrScene *scene, Cut *cut, WrModel *m, WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    const int steps = info->flat && !info->closed_u && !info->corners ? 1 : STEPS;
    if (!reserve(m, info->faces * LINES * (steps + 1), info->faces * LINES * 2 * steps, err))
        return false;
    for (int face = 0; face < info->faces; face++) cut_face(cut, face, steps, m);
    m->mapped = true;
    m->per_u = cut->area > 0 ? cut->per_u / cut->area : 1;
    m->per_v = cut->area > 0 ? cut->per_v / cut->area : 1;
    return true;
}

/* Errors: cancelled, no memory. On failure `model` is empty. */
static bool model_make(const WrScene *scene, WrModel *model, WrError *err)
{
    *model = (WrModel){ 0 };
    Cut cut = { .shape = &scene->shape };
    wr_scene_stretch(scene, &cut.stretch, &cut.cofactor);
    cut.mirrored = cut.stretch.x * cut.stretch.y * cut.stretch.z < 0;
    bool good;
    if (wr_surfaces[scene->shape.kind]->held) {
        WrTriangles *own = scene->triangles ? NULL : wr_triangles_square();
        good = take_triangles(own ? own : scene->triangles, cut.stretch, cut.cofactor, cut.mirrored,
                              model, err);
        wr_triangles_free(own);
    } else {
        good = cut_surface(scene, &cut, model, err);
    }
    if (good && wr_progress_stopped()) good = wr_fail(err, "cancelled");
    if (!good) model_fini(model);
    return good;
}

/* ---- triangles of a solid ---- */

/* Corners of a body by point: those of point i are corners[first[i]] to corners[first[i + 1] - 1], each 3 times its triangle
   and its number there. */
typedef struct Fans {
    int32_t *first, *corners; /* [point_count + 1], [3 * triangle_count]; owned */
    WrVec3 *areas;            /* [triangle_count] area vectors; owned */
} Fans;

static void fans_fini(Fans *fans)
{
    wr_free(fans->first);
    wr_free(fans->corners);
    wr_free(fans->areas);
}

static bool fans_make(const WrSolidBody *body, Fans *fans, WrError *err)
{
    const size_t points = (size_t)body->point_count, count = (size_t)body->triangle_count;
    fans->first = wr_try_alloc(points + 1, sizeof *fans->first, "a model", err);
    fans->corners =
        fans->first ? wr_try_alloc_unset(3 * count, sizeof *fans->corners, "a model", err) : NULL;
    fans->areas =
        fans->corners ? wr_try_alloc_unset(count, sizeof *fans->areas, "a model", err) : NULL;
    if (!fans->areas) return false;
    for (size_t i = 0; i < count; i++) {
        const int32_t *t = body->triangles[i];
        fans->areas[i] = wr_solid_body_area(body, t[0], t[1], t[2]);
        for (int k = 0; k < 3; k++) fans->first[t[k]]++;
    }
    int32_t sum = 0;
    for (size_t i = 0; i <= points; i++) sum = fans->first[i] += sum;
    for (size_t i = 3 * count; i-- > 0;)
        fans->corners[--fans->first[body->triangles[i / 3][i % 3]]] = (int32_t)i;
    return true;
}

/* Weight of a triangle's area vector in the normal at one of its corners, whose sides are a and b: 1 / (a.a b.b). The sum about
   a point is exact for points on a sphere, however thin the triangles (N. Max, Weights for computing vertex normals from facet
   normals, 1999). */
static double corner_weight(const WrSolidBody *body, int32_t corner)
{
    const int32_t *t = body->triangles[corner / 3];
    const WrVec3 p = wr_solid_body_point(body, t[corner % 3]);
    const WrVec3 a = v3_sub(wr_solid_body_point(body, t[(corner + 1) % 3]), p);
    const WrVec3 b = v3_sub(wr_solid_body_point(body, t[(corner + 2) % 3]), p);
    const double sides = v3_dot(a, a) * v3_dot(b, b);
    return sides > 0 ? 1 / sides : 0;
}

#define SMOOTH 0.587 /* cos^2 of 40 degrees */

/* The sum about a corner's point over the triangles that are tilted against its own by at most 40 degrees: flatter
   edges are shaded smooth, others hard. A thin triangle on a curved surface, as at a sphere's pole, can be tilted by as much: so
   the sum takes its place, twice, and moves to the direction of most triangles. */
static WrVec3 corner_normal(const WrSolidBody *body, const Fans *fans, int32_t point,
                            int32_t corner)
{
    WrVec3 own = fans->areas[corner / 3];
    for (int round = 0; round < 3; round++) {
        WrVec3 sum = { 0, 0, 0 };
        for (int32_t i = fans->first[point]; i < fans->first[point + 1]; i++) {
            const WrVec3 other = fans->areas[fans->corners[i] / 3];
            const double dot = v3_dot(own, other);
            if (dot > 0 && dot * dot >= SMOOTH * v3_dot(own, own) * v3_dot(other, other))
                sum = v3_add(sum, v3_scale(other, corner_weight(body, fans->corners[i])));
        }
        own = sum;
    }
    return v3_unit(own, (WrVec3){ 0, 0, 1 });
}

/* A vertex for each normal and (u,v) at a point. cells: (u,v) of the body are in cells, those of a model are not. */
static void take_corner(const WrSolidBody *body, const Fans *fans, int32_t corner,
                        const double cells[2], int32_t first, WrModel *m)
{
    const int32_t point = body->triangles[corner / 3][corner % 3];
    float normal[3], uv[2];
    put(normal, corner_normal(body, fans, point, corner));
    for (int k = 0; k < 2; k++)
        uv[k] = (float)((double)body->uv[corner / 3][corner % 3][k] / cells[k]);
    int32_t at = first;
    while (at < m->point_count && (memcmp(m->normals[at], normal, sizeof normal) != 0 ||
                                   memcmp(m->uv[at], uv, sizeof uv) != 0))
        at++;
    if (at == m->point_count) {
        put(m->points[at], v3_scale(wr_solid_body_point(body, point), 1e-3)); /* mm to metres */
        memcpy(m->normals[at], normal, sizeof normal);
        memcpy(m->uv[at], uv, sizeof uv);
        m->point_count++;
    }
    m->triangles[corner / 3][corner % 3] = (uint32_t)at;
}

static bool take_body(const WrSolidBody *body, const WrScene *scene, WrModel *m, WrError *err)
{
    const double cells[2] = { scene->replicate_u, scene->replicate_v };
    Fans fans = { 0 };
    const bool good = reserve(m, 3 * body->triangle_count, body->triangle_count, err) &&
                      fans_make(body, &fans, err);
    for (int32_t i = 0; good && i < body->point_count; i++) {
        const int32_t first = m->point_count;
        for (int32_t k = fans.first[i]; k < fans.first[i + 1]; k++)
            take_corner(body, &fans, fans.corners[k], cells, first, m);
    }
    m->triangle_count = body->triangle_count;
    m->mapped = m->raised = true;
    fans_fini(&fans);
    return good;
}

static void model_fini(WrModel *model)
{
    wr_free(model->points);
    wr_free(model->normals);
    wr_free(model->uv);
    wr_free(model->triangles);
    *model = (WrModel){ 0 };
}

enum { NORMAL, PACKED, COLOUR, MAPS };

/* One picture of the file. */
typedef struct Map {
    char *png; /* owned; NULL: there is none */
    size_t length;
    double repeat[2]; /* times that it lies over u and v 0..1 */
} Map;

typedef struct Glb {
    const WrExportJob *job;
    WrModel model;
    Map maps[MAPS];
    double repeat[2]; /* TEXCOORD_0 is u and v times these, v downwards */
    int count;        /* of maps */
    WrText json, bin;
} Glb;

/* ---- pictures ---- */

typedef struct Source {
    int width;
    const uint8_t *rgb;    /* codes; NULL: */
    const WrImage *colour; /* linear light */
} Source;

static bool source_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Source *s = ctx;
    const size_t first = (size_t)y * (size_t)s->width, count = (size_t)rows * (size_t)s->width;
    uint8_t *to = out;
    (void)err;
    if (s->rgb) {
        memcpy(to, s->rgb + 3 * first, 3 * count);
        return true;
    }
    const int channels = s->colour->channels;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            const int from = channels >= 3 ? c : 0;
            const float x = s->colour->data[(first + i) * (size_t)channels + (size_t)from];
            const float code = wr_srgb_encode(fminf(fmaxf(x, 0), 1));
            to[3 * i + (size_t)c] = (uint8_t)lrintf(255 * code);
        }
    return true;
}

static bool encode(Source *source, int height, bool data, Map *map, WrError *err)
{
    const WrImageOut out = { .width = source->width,
                             .height = height,
                             .channels = 3,
                             .type = WR_PIXEL_U8,
                             .data = data,
                             .rows = source_rows,
                             .ctx = source };
    return wr_image_write_bytes("map.png", &out, &map->png, &map->length, err);
}

/* A map of another kind, of the same table, as 8-bit codes. */
static bool add_map(Glb *glb, const char *kind, int which, const double repeat[2], WrError *err)
{
    WrExportJob job = *glb->job;
    WrExportPreview picture;
    job.options.depth = 8;
    if (which == NORMAL) { /* slopes are those of one cell as it lies on the surface, on average */
        job.options.cell_w = glb->model.per_u / fabs(repeat[0]);
        job.options.cell_h = glb->model.per_v / fabs(repeat[1]);
    }
    bool good = wr_export_preview_like(&job, wr_export_find(kind), &picture, err);
    Source source = { picture.width, picture.rgb, NULL };
    Map *map = &glb->maps[which];
    good = good && encode(&source, picture.height, true, map, err);
    memcpy(map->repeat, repeat, sizeof map->repeat);
    wr_export_preview_fini(&picture);
    return good;
}

bool wr_gltf_colour_png(const WrImage *colour, char **bytes, size_t *length, WrError *err)
{
    Source source = { colour->width, NULL, colour };
    Map map = { 0 };
    if (!encode(&source, colour->height, false, &map, err)) return false;
    *bytes = map.png, *length = map.length;
    return true;
}

static bool add_colour(Glb *glb, const double cells[2], WrError *err)
{
    const WrScene *scene = glb->job->scene;
    if (!scene->colour) return true;
    Map *map = &glb->maps[COLOUR];
    map->repeat[0] = scene->colour_laid.own ? scene->colour_laid.ru : cells[0];
    map->repeat[1] = scene->colour_laid.own ? scene->colour_laid.rv : cells[1];
    return wr_gltf_colour_png(scene->colour, &map->png, &map->length, err);
}

/* Of a mesh the normal map is baked, in the frames that glTF's readers compute; else it is that of a cell, repeated. */
static bool add_maps(Glb *glb, WrError *err)
{
    const WrScene *scene = glb->job->scene;
    const double cells[2] = { scene->replicate_u, scene->replicate_v }, once[2] = { 1, 1 };
    const bool held = wr_surfaces[scene->shape.kind]->held;
    const double *base = held && !glb->model.raised ? once : cells;
    WrProgressPart part;
    memcpy(glb->repeat, base, sizeof glb->repeat);
    if (!glb->model.mapped) return true;
    const WrProgress *whole = wr_progress_enter(&part, 0.1, 0.4);
    bool good =
        glb->model.raised || add_map(glb, held ? "normal-baked" : "normal+y", NORMAL, base, err);
    wr_progress_set(whole);
    wr_progress_enter(&part, 0.4, 0.8);
    good = good && add_map(glb, "packed", PACKED, cells, err);
    wr_progress_set(whole);
    return good && add_colour(glb, cells, err);
}

/* ---- the binary chunk ---- */

/* glTF 3.6.2: the offset of an accessor's data is a multiple of its component size, and so is a chunk's length (4.4.3): every
   view is padded to 4 bytes. */
static void add_bytes(Glb *glb, const void *bytes, size_t length)
{
    wr_text_add_n(&glb->bin, bytes, length);
    while (glb->bin.length % 4) wr_text_add_n(&glb->bin, "", 1);
}

static void add_uint(WrText *text, uint32_t x)
{
    const char bytes[4] = { (char)(x & 255), (char)(x >> 8 & 255), (char)(x >> 16 & 255),
                            (char)(x >> 24) };
    wr_text_add_n(text, bytes, 4);
}

static void add_float(WrText *text, float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    add_uint(text, bits);
}

/* An entry of bufferViews. */
static void add_view(Glb *glb, size_t from, size_t length, int target)
{
    wr_text_addf(&glb->json, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu",
                 from ? "," : "", from, length);
    if (target) wr_text_addf(&glb->json, ",\"target\":%d", target);
    wr_text_add(&glb->json, "}");
}

/* Views 0 to 3 are places, normals, (u,v) and corners; then one for each map. Components are float32 (5126) and uint32
   (5125); 34962 is ARRAY_BUFFER, 34963 ELEMENT_ARRAY_BUFFER. Pictures have no target. */
static void add_views(Glb *glb)
{
    const WrModel *m = &glb->model;
    size_t from = 0;
    wr_text_add(&glb->json, "\"bufferViews\":[");
    for (int k = 0; k < 4; k++) {
        for (int32_t i = 0; k < 2 && i < m->point_count; i++)
            for (int c = 0; c < 3; c++)
                add_float(&glb->bin, k == 0 ? m->points[i][c] : m->normals[i][c]);
        for (int32_t i = 0; k == 2 && i < m->point_count; i++) {
            /* v points up here and down in glTF: TEXCOORD v = 1 - repeat v. */
            const bool is = isfinite(m->uv[i][0]) && isfinite(m->uv[i][1]);
            add_float(&glb->bin, is ? (float)((double)m->uv[i][0] * glb->repeat[0]) : 0);
            add_float(&glb->bin, is ? (float)(1 - (double)m->uv[i][1] * glb->repeat[1]) : 0);
        }
        for (int32_t i = 0; k == 3 && i < m->triangle_count; i++)
            for (int c = 0; c < 3; c++) add_uint(&glb->bin, m->triangles[i][c]);
        add_view(glb, from, glb->bin.length - from, k == 3 ? 34963 : 34962);
        from = glb->bin.length;
    }
    for (int k = 0; k < MAPS; k++) {
        if (!glb->maps[k].png) continue;
        add_bytes(glb, glb->maps[k].png, glb->maps[k].length);
        add_view(glb, from, glb->maps[k].length, 0);
        from = glb->bin.length;
    }
    wr_text_add(&glb->json, "]");
}

/* ---- JSON ---- */

static void add_number(Glb *glb, double x)
{
    wr_text_add_number(&glb->json, x);
}

/* Bounds of POSITION are required (3.7.2.1) and must be the float32 values that are stored. */
static void add_accessors(Glb *glb)
{
    const WrModel *m = &glb->model;
    float low[3], high[3];
    memcpy(low, m->points[0], sizeof low);
    memcpy(high, m->points[0], sizeof high);
    for (int32_t i = 1; i < m->point_count; i++)
        for (int c = 0; c < 3; c++) {
            low[c] = fminf(low[c], m->points[i][c]);
            high[c] = fmaxf(high[c], m->points[i][c]);
        }
    wr_text_addf(&glb->json,
                 ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%d,"
                 "\"type\":\"VEC3\"",
                 m->point_count);
    for (int end = 0; end < 2; end++) {
        wr_text_add(&glb->json, end ? ",\"max\":[" : ",\"min\":[");
        for (int c = 0; c < 3; c++) {
            if (c) wr_text_add(&glb->json, ",");
            add_number(glb, (double)(end ? high : low)[c]);
        }
        wr_text_add(&glb->json, "]");
    }
    wr_text_addf(&glb->json,
                 "},{\"bufferView\":1,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"},"
                 "{\"bufferView\":2,\"componentType\":5126,\"count\":%d,\"type\":\"VEC2\"},"
                 "{\"bufferView\":3,\"componentType\":5125,\"count\":%d,\"type\":\"SCALAR\"}]",
                 m->point_count, m->point_count, 3 * m->triangle_count);
}

static bool repeats_otherwise(const Glb *glb, const Map *map)
{
    return map->png && !(fabs(map->repeat[0] - glb->repeat[0]) <= 0 &&
                         fabs(map->repeat[1] - glb->repeat[1]) <= 0);
}

/* "NAME":{"index":N ...}; nothing where there is no such map. v is 1 - repeat v both before and after the transform. */
static void add_texture(Glb *glb, const char *name, int which)
{
    const Map *map = &glb->maps[which];
    if (!map->png) return;
    int index = 0;
    for (int k = 0; k < which; k++) index += glb->maps[k].png != NULL;
    wr_text_addf(&glb->json, ",\"%s\":{\"index\":%d", name, index);
    if (repeats_otherwise(glb, map)) {
        /* TEXCOORD_0 is t = 1 - r v with the repeat r of the normal map. A map of repeat r' needs t' = 1 - r' v = (r'/r) t +
           1 - r'/r, the extension's scale and offset; along u there is no offset. */
        const double x = map->repeat[0] / glb->repeat[0], y = map->repeat[1] / glb->repeat[1];
        wr_text_add(&glb->json, ",\"extensions\":{\"KHR_texture_transform\":{\"scale\":[");
        add_number(glb, x);
        wr_text_add(&glb->json, ",");
        add_number(glb, y);
        wr_text_add(&glb->json, "],\"offset\":[0,");
        add_number(glb, 1 - y);
        wr_text_add(&glb->json, "]}}");
    }
    wr_text_add(&glb->json, "}");
}

/* The packed picture holds occlusion, roughness and metalness in red, green and blue, as glTF requires. */
static void add_material(Glb *glb)
{
    const WrMaterial *m = &glb->job->scene->material;
    const double colour[3] = { m->colour.x, m->colour.y, m->colour.z };
    wr_text_add(&glb->json, ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[");
    for (int c = 0; c < 3; c++) {
        add_number(glb, fmin(fmax(colour[c], 0), 1));
        wr_text_add(&glb->json, ",");
    }
    wr_text_add(&glb->json, glb->maps[PACKED].png ? "1]" : "1],\"metallicFactor\":0");
    add_texture(glb, "baseColorTexture", COLOUR);
    add_texture(glb, "metallicRoughnessTexture", PACKED);
    wr_text_add(&glb->json, "}");
    add_texture(glb, "normalTexture", NORMAL);
    add_texture(glb, "occlusionTexture", PACKED);
    if (wr_surfaces[glb->job->scene->shape.kind]->open)
        wr_text_add(&glb->json, ",\"doubleSided\":true");
    wr_text_add(&glb->json, "}]");
}

static void add_pictures(Glb *glb)
{
    static const char *const names[MAPS] = { "normal", "occlusion-roughness-metalness", "colour" };
    if (!glb->count) return;
    wr_text_add(&glb->json, ",\"samplers\":[{\"wrapS\":10497,\"wrapT\":10497}],\"textures\":[");
    for (int k = 0; k < glb->count; k++)
        wr_text_addf(&glb->json, "%s{\"sampler\":0,\"source\":%d}", k ? "," : "", k);
    wr_text_add(&glb->json, "],\"images\":[");
    int at = 0;
    for (int k = 0; k < MAPS; k++)
        if (glb->maps[k].png) {
            wr_text_addf(&glb->json,
                         "%s{\"name\":\"%s\",\"mimeType\":\"image/png\",\"bufferView\":%d}",
                         at ? "," : "", names[k], 4 + at);
            at++;
        }
    wr_text_add(&glb->json, "]");
}

static void add_nodes(Glb *glb)
{
    wr_text_addf(&glb->json,
                 ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1%s},"
                 "\"indices\":3,\"material\":0}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":"
                 "[0]}],\"scene\":0",
                 glb->model.mapped ? ",\"TEXCOORD_0\":2" : "");
}

static void describe(Glb *glb)
{
    bool moved = false;
    for (int k = 0; k < MAPS; k++) {
        glb->count += glb->maps[k].png != NULL;
        moved |= repeats_otherwise(glb, &glb->maps[k]);
    }
    wr_text_add(&glb->json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Wrinkle\"},");
    if (moved) wr_text_add(&glb->json, "\"extensionsUsed\":[\"KHR_texture_transform\"],");
    add_views(glb);
    add_accessors(glb);
    add_pictures(glb);
    add_material(glb);
    add_nodes(glb);
    wr_text_addf(&glb->json, ",\"buffers\":[{\"byteLength\":%zu}]}", glb->bin.length);
    while (glb->json.length % 4) wr_text_add(&glb->json, " ");
}

/* ---- the file ---- */

/* GLB: magic "glTF", uint32 version 2, uint32 total length; then chunks of uint32 length, four-letter type and bytes: first
   JSON padded with spaces, then BIN padded with zeros. 28 = header 12 + two chunk headers of 8. All numbers are little
   endian. */
static bool write_file(Glb *glb, const char *path, WrError *err)
{
    WrText head = { 0 }, between = { 0 };
    WrFileTarget target;
    const size_t all = 28 + glb->json.length + glb->bin.length;
    if (all > UINT32_MAX)
        return wr_fail(err, "%s: larger than 4 GB, which GLB files cannot be", path);
    if (!wr_file_begin(&target, path, err)) return false;
    wr_text_add(&head, "glTF");
    add_uint(&head, 2);
    add_uint(&head, (uint32_t)all);
    add_uint(&head, (uint32_t)glb->json.length);
    wr_text_add(&head, "JSON");
    add_uint(&between, (uint32_t)glb->bin.length);
    wr_text_add_n(&between, "BIN\0", 4);
    const bool good = wr_file_put(&target, head.data, head.length, err) &&
                      wr_file_put(&target, glb->json.data, glb->json.length, err) &&
                      wr_file_put(&target, between.data, between.length, err) &&
                      wr_file_put(&target, glb->bin.data, glb->bin.length, err);
    wr_text_fini(&head);
    wr_text_fini(&between);
    if (good) return wr_file_commit(&target, err);
    wr_file_abort(&target);
    return false;
}

/* Adds maps to the model and writes both. Frees the model. */
static bool write_model(Glb *glb, const char *path, WrError *err)
{
    bool good = add_maps(glb, err);
    if (good && glb->model.triangle_count == 0)
        good = wr_fail(err, "%s: the surface has no area", path);
    if (good) {
        describe(glb);
        good = write_file(glb, path, err);
    }
    for (int k = 0; k < MAPS; k++) wr_free(glb->maps[k].png);
    model_fini(&glb->model);
    wr_text_fini(&glb->json);
    wr_text_fini(&glb->bin);
    return good;
}

bool wr_export_glb_write(WrExportJob *job, const char *path, WrError *err)
{
    Glb glb = { .job = job };
    if (!model_make(job->scene, &glb.model, err)) return false;
    job->report.triangles = glb.model.triangle_count;
    job->report.model = true;
    const bool good = write_model(&glb, path, err);
    job->report.pictures = glb.count;
    return good;
}

bool wr_export_gltf_write(WrExportJob *job, const char *path, WrError *err)
{
    Glb glb = { .job = job };
    WrSolidBody body = { 0 };
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.7);
    bool good =
        wr_export_solid_make(job, &body, err) && take_body(&body, job->scene, &glb.model, err);
    wr_progress_set(whole);
    wr_solid_body_fini(&body);
    if (!good) {
        model_fini(&glb.model);
        return false;
    }
    wr_progress_enter(&part, 0.7, 1.0);
    good = write_model(&glb, path, err);
    wr_progress_set(whole);
    return good;
}

/* ---- the model of a .gltf file ---- */

/* A rectangle about the origin, towards +z. */
static bool lay_rectangle(const double size[2], WrModel *m, WrError *err)
{
    if (!reserve(m, 4, 2, err)) return false;
    for (int32_t i = 0; i < 4; i++) {
        const float u = (float)(i & 1), v = (float)(i >> 1);
        put(m->points[i], (WrVec3){ ((i & 1) - 0.5) * size[0], ((i >> 1) - 0.5) * size[1], 0 });
        put(m->normals[i], (WrVec3){ 0, 0, 1 });
        m->uv[i][0] = u, m->uv[i][1] = v;
    }
    m->point_count = 4;
    m->mapped = true;
    add_triangle(m, 0, 1, 3, false);
    add_triangle(m, 0, 3, 2, false);
    return true;
}

bool wr_gltf_add_model(const WrScene *scene, const double size[2], const double repeat[2],
                       WrText *json, WrText *bin, WrError *err)
{
    WrExportJob job = { .scene = scene };
    Glb glb = { .job = &job, .repeat = { repeat[0], repeat[1] }, .json = *json, .bin = *bin };
    bool good = size ? lay_rectangle(size, &glb.model, err) : model_make(scene, &glb.model, err);
    if (good && glb.model.triangle_count == 0)
        good = wr_fail(err, "%s: the surface has no area", "gltf");
    if (good) {
        add_views(&glb);
        add_accessors(&glb);
        add_nodes(&glb);
    }
    *json = glb.json, *bin = glb.bin;
    model_fini(&glb.model);
    return good;
}
