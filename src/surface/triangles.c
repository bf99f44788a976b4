#include "surface/triangles.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "surface/patches.h"
#include "surface/triangles_internal.h"

#include <string.h>

/* ---- merging of equal positions ---- */

static uint32_t mix(const void *key, size_t size)
{
    const unsigned char *from = key;
    uint32_t h = 0x9e3779b9U;
    for (size_t i = 0; i < size; i += 4) {
        uint32_t word;
        memcpy(&word, from + i, 4);
        h = wr_mix32(h ^ word) + 0x9e3779b9U;
    }
    return h;
}

bool wr_weld(const void *rows, size_t size, int32_t count, int32_t *to, int32_t *kinds,
             WrError *err)
{
    size_t room = 16;
    while (room < 2 * (size_t)count) room *= 2;
    int32_t *table = wr_try_alloc(room, sizeof *table, "a mesh's places", err); /* 1 + the first */
    if (!table) return false;
    const char *bytes = rows;
    int32_t found = 0;
    for (int32_t i = 0; i < count; i++) {
        const char *row = bytes + (size_t)i * size;
        size_t at = mix(row, size) & (room - 1);
        while (table[at] && memcmp(bytes + (size_t)(table[at] - 1) * size, row, size) != 0)
            at = (at + 1) & (room - 1);
        if (!table[at]) {
            table[at] = i + 1;
            to[i] = found++;
        } else {
            to[i] = to[table[at] - 1];
        }
    }
    wr_free(table);
    *kinds = found;
    return true;
}

/* ---- faces ---- */

static WrVec3 place(const WrTrianglesBuild *b, int32_t point)
{
    const float *p = b->points[point];
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

/* The cross product of the triangle's two shortest edges, oriented by the winding; *from: the corner
   between them. */
static WrVec3 face_of(const WrVec3 p[3], int *from)
{
    double side[3]; /* of the edge opposite corner i, relative to the longest */
    for (int i = 0; i < 3; i++) side[i] = v3_len(v3_sub(p[(i + 2) % 3], p[(i + 1) % 3]));
    int longest = 0;
    for (int i = 1; i < 3; i++)
        if (side[i] > side[longest]) longest = i;
    *from = longest;
    return v3_cross(v3_sub(p[(longest + 1) % 3], p[longest]),
                    v3_sub(p[(longest + 2) % 3], p[longest]));
}

static bool usable(WrVec3 n)
{
    const double l = v3_len(n);
    return l > 0 && isfinite(l);
}

/* Keeps the triangles with an area, each from the corner between its two shortest edges; computes their
 * normals. */
static void keep_faces(WrTrianglesBuild *b)
{
    const WrVec3 none = { 0, 0, 0 };
    int32_t kept = 0;
    for (int32_t i = 0; i < b->source->triangle_count; i++) {
        const int32_t *c = b->source->corners[i];
        const WrVec3 p[3] = { place(b, c[0]), place(b, c[1]), place(b, c[2]) };
        int from;
        const WrVec3 n = face_of(p, &from);
        if (b->at[c[0]] == b->at[c[1]] || b->at[c[1]] == b->at[c[2]] ||
            b->at[c[2]] == b->at[c[0]] || !usable(n)) {
            b->told.no_area++;
            continue;
        }
        for (int k = 0; k < 3; k++) b->face[kept].corner[k] = c[(from + k) % 3];
        b->normal[kept] = v3_unit(n, none);
        b->of[kept++] = i;
    }
    b->count = kept;
}

/* ---- closed bodies ---- */

/* For each position, the other ends of its outgoing (or incoming) directed edges. */
typedef struct Ends {
    int32_t *first; /* [places + 1] into place */
    int32_t *place; /* [3 count] */
} Ends;

static bool find_ends(const WrTrianglesBuild *b, bool leaving, Ends *out)
{
    const size_t edges = 3 * (size_t)b->count;
    int32_t *at = wr_try_alloc((size_t)b->places + 2, sizeof *at, "a mesh's edges", NULL);
    out->first = at;
    out->place = at ? wr_try_alloc(edges, sizeof *out->place, "a mesh's edges", NULL) : NULL;
    if (!out->place) return false;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < edges; i++) {
            const int32_t *c = b->face[i / 3].corner;
            const int32_t from = b->at[c[i % 3]], to = b->at[c[(i + 1) % 3]];
            const int32_t own = leaving ? from : to;
            if (pass == 0) at[own + 2]++;
            else out->place[at[own + 1]++] = leaving ? to : from;
        }
        for (int32_t i = 0; i < b->places && pass == 0; i++) at[i + 2] += at[i + 1];
    }
    return true;
}

static void free_ends(Ends *ends)
{
    wr_free(ends->first);
    wr_free(ends->place);
}

static int32_t end_count(const Ends *ends, int32_t place)
{
    return ends->first[place + 1] - ends->first[place];
}

static int32_t times(const Ends *ends, int32_t place, int32_t other)
{
    int32_t found = 0;
    for (int32_t i = ends->first[place]; i < ends->first[place + 1]; i++)
        found += ends->place[i] == other;
    return found;
}

/* Multiplicity of the edge; searched at its end with fewer edges, so that the hub of a fan costs no
 * more than others. */
static int32_t how_often(const Ends *leave, const Ends *come, int32_t from, int32_t to)
{
    return end_count(leave, from) <= end_count(come, to) ? times(leave, from, to)
                                                         : times(come, to, from);
}

/* True if each directed edge exists once, and its reverse too. */
static bool is_closed(const WrTrianglesBuild *b)
{
    Ends leave = { NULL, NULL }, come = { NULL, NULL };
    bool closed = find_ends(b, true, &leave) && find_ends(b, false, &come);
    for (int32_t i = 0; i < 3 * b->count && closed; i++) {
        const int32_t *c = b->face[i / 3].corner;
        const int32_t from = b->at[c[i % 3]], to = b->at[c[(i + 1) % 3]];
        closed = how_often(&leave, &come, from, to) == 1 && how_often(&leave, &come, to, from) == 1;
    }
    free_ends(&leave);
    free_ends(&come);
    return closed;
}

/* The bounding sphere about the box's centre; its size defines the scale in which volumes are summed. */
static void find_ball(WrTrianglesBuild *b)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    for (int32_t i = 0; i < 3 * b->count; i++) {
        const float *p = b->points[b->face[i / 3].corner[i % 3]];
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], (double)p[k]);
            high[k] = fmax(high[k], (double)p[k]);
        }
    }
    for (int k = 0; k < 3; k++) b->centre[k] = low[k] / 2 + high[k] / 2;
    const WrVec3 centre = { b->centre[0], b->centre[1], b->centre[2] };
    double most = 0;
    for (int32_t i = 0; i < 3 * b->count; i++)
        most = fmax(most, v3_len(v3_sub(place(b, b->face[i / 3].corner[i % 3]), centre)));
    b->radius = fmax(most * (1 + 1e-12), 1e-30);
}

static double volume(const WrTrianglesBuild *b)
{
    const WrVec3 centre = { b->centre[0], b->centre[1], b->centre[2] };
    const double per = 1 / b->radius;
    double sum = 0;
    for (int32_t i = 0; i < b->count; i++) {
        WrVec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = v3_scale(v3_sub(place(b, b->face[i].corner[k]), centre), per);
        sum += v3_dot(p[0], v3_cross(p[1], p[2]));
    }
    return sum;
}

static void turn_out(WrTrianglesBuild *b)
{
    b->told.inside_out = true;
    for (int32_t i = 0; i < b->count; i++) {
        int32_t *c = b->face[i].corner;
        const int32_t last = c[2];
        c[2] = c[1], c[1] = last;
        b->normal[i] = v3_neg(b->normal[i]);
    }
}

/* ---- normals ---- */

static double corner_angle(const WrTrianglesBuild *b, int32_t i, int k)
{
    const int32_t *c = b->face[i].corner;
    const WrVec3 p = place(b, c[k]);
    return wr_angle(v3_sub(place(b, c[(k + 1) % 3]), p), v3_sub(place(b, c[(k + 2) % 3]), p));
}

/* Copies the file's normals as unit vectors; 0 where they are unusable. */
static void take_normals(WrTrianglesBuild *b)
{
    const WrVec3 none = { 0, 0, 0 };
    for (int32_t i = 0; i < b->source->point_count; i++) {
        const float *given = b->source->normals ? b->source->normals[i] : NULL;
        const WrVec3 n =
            given ? (WrVec3){ (double)given[0], (double)given[1], (double)given[2] } : none;
        b->own[i] = usable(n) ? v3_unit(n, none) : none;
        if (!given) b->told.no_normal++;
        else if (!usable(n)) b->told.bad_normal++;
    }
}

static bool is_none(WrVec3 n)
{
    return n.x == 0 && n.y == 0 && n.z == 0;
}

/* Flips the file's normals if most of them point into the reversed body. */
static void turn_normals(WrTrianglesBuild *b)
{
    double sum = 0;
    for (int32_t i = 0; i < 3 * b->count; i++)
        sum += v3_dot(b->own[b->face[i / 3].corner[i % 3]], b->normal[i / 3]);
    for (int32_t i = 0; i < b->source->point_count && sum < 0; i++) b->own[i] = v3_neg(b->own[i]);
}

/* Computes missing normals from the faces about the position. */
static bool fill_normals(WrTrianglesBuild *b, WrError *err)
{
    const WrVec3 none = { 0, 0, 0 };
    if (b->told.no_normal + b->told.bad_normal == 0) return true;
    WrVec3 *sum = wr_try_alloc((size_t)b->places, sizeof *sum, "a mesh's normals", err);
    if (!sum) return false;
    for (int32_t i = 0; i < b->count; i++)
        for (int k = 0; k < 3; k++) {
            WrVec3 *at = &sum[b->at[b->face[i].corner[k]]];
            *at = v3_mad(*at, b->normal[i], corner_angle(b, i, k));
        }
    for (int32_t i = 0; i < b->source->point_count; i++) {
        const WrVec3 n = sum[b->at[i]];
        if (is_none(b->own[i])) b->own[i] = v3_len(n) > 1e-9 ? v3_unit(n, none) : none;
    }
    wr_free(sum);
    return true;
}

/* ---- corners ---- */

static bool good_uv(const float *uv)
{
    return fabsf(uv[0]) <= 1e6f && fabsf(uv[1]) <= 1e6f;
}

/* Corner k of face i; returns true if it has (u,v). */
static bool make_corner(WrTrianglesBuild *b, int32_t i, int k, WrTriangleCorner *out)
{
    const int32_t point = b->face[i].corner[k];
    WrVec3 n = b->own[point];
    if (is_none(n)) {
        n = b->normal[i];
        b->told.face_normal++;
    }
    memcpy(out->p, b->points[point], sizeof out->p);
    out->n[0] = (float)n.x + 0.0f, out->n[1] = (float)n.y + 0.0f, out->n[2] = (float)n.z + 0.0f;
    out->u = out->v = 0;
    if (!b->source->uv) return false;
    const float *uv = b->source->uv[point];
    if (!good_uv(uv)) return false;
    out->u = uv[0] + 0.0f, out->v = uv[1] + 0.0f;
    return true;
}

static void make_face(WrTrianglesBuild *b, int32_t i)
{
    WrTriangleCorner *out = b->corner + 3 * (size_t)i;
    int with = 0;
    for (int k = 0; k < 3; k++) with += make_corner(b, i, k, &out[k]);
    b->mapped[i] = with == 3;
    for (int k = 0; k < 3 && with < 3; k++) out[k].u = out[k].v = 0;
    if (with < 3) b->told.no_map++;
}

static void count_bad_uv(WrTrianglesBuild *b)
{
    for (int32_t i = 0; i < b->source->point_count && b->source->uv; i++)
        b->told.bad_uv += !good_uv(b->source->uv[i]);
}

/* Counts the orientations of the (u,v) of mapped faces. */
static void count_maps(WrTrianglesBuild *b)
{
    for (int32_t i = 0; i < b->count; i++) {
        const WrTriangleCorner *c = b->corner + 3 * (size_t)i;
        if (!b->mapped[i]) continue;
        const double u1 = (double)c[1].u - (double)c[0].u, v1 = (double)c[1].v - (double)c[0].v;
        const double u2 = (double)c[2].u - (double)c[0].u, v2 = (double)c[2].v - (double)c[0].v;
        const double a = u1 * v2, d = u2 * v1;
        if (fabs(a - d) <= WR_COLLINEAR * (fabs(a) + fabs(d))) b->told.collinear++;
        else b->told.mirrored += a < d;
    }
}

/* ---- construction ---- */

static bool check_source(const WrTrianglesSource *source, WrError *err)
{
    if (source->triangle_count < 1 || source->triangle_count > WR_TRIANGLES_MAX ||
        source->point_count < 3 || source->point_count > 3 * WR_TRIANGLES_MAX)
        return wr_fail(err, "a mesh of %d triangles and %d points: must be 1..%d triangles",
                       (int)source->triangle_count, (int)source->point_count, WR_TRIANGLES_MAX);
    for (int32_t i = 0; i < 3 * source->triangle_count; i++) {
        const int32_t c = source->corners[i / 3][i % 3];
        if (c < 0 || c >= source->point_count)
            return wr_fail(err, "triangle %d names point %d of %d", (int)(i / 3 + 1), (int)c,
                           (int)source->point_count);
    }
    for (int32_t i = 0; i < source->point_count; i++) {
        const float *p = source->points[i];
        if (!(fabsf(p[0]) <= 1e30f && fabsf(p[1]) <= 1e30f && fabsf(p[2]) <= 1e30f))
            return wr_fail(err, "point %d is %g,%g,%g: must be finite, within 1e30 of 0",
                           (int)i + 1, (double)p[0], (double)p[1], (double)p[2]);
    }
    int64_t sum = 0;
    for (int32_t i = 0; i < source->part_count; i++) {
        if (source->parts[i].first != sum || source->parts[i].count < 0) sum = -1;
        if (sum < 0) break;
        sum += source->parts[i].count;
    }
    if (source->parts &&
        (sum != source->triangle_count || source->part_count > WR_TRIANGLE_PARTS_MAX))
        return wr_fail(err, "a mesh's %d parts: must hold all triangles in order, in at most %d",
                       (int)source->part_count, WR_TRIANGLE_PARTS_MAX);
    return true;
}

static bool begin(WrTrianglesBuild *b, WrError *err)
{
    const WrTrianglesSource *source = b->source;
    const size_t points = (size_t)source->point_count, faces = (size_t)source->triangle_count;
    const char *what = "a mesh";
    b->points = wr_try_alloc(points, sizeof *b->points, what, err);
    b->at = b->points ? wr_try_alloc(points, sizeof *b->at, what, err) : NULL;
    b->own = b->at ? wr_try_alloc(points, sizeof *b->own, what, err) : NULL;
    b->face = b->own ? wr_try_alloc(faces, sizeof *b->face, what, err) : NULL;
    b->of = b->face ? wr_try_alloc(faces, sizeof *b->of, what, err) : NULL;
    b->normal = b->of ? wr_try_alloc(faces, sizeof *b->normal, what, err) : NULL;
    b->mapped = b->normal ? wr_try_alloc(faces, sizeof *b->mapped, what, err) : NULL;
    b->corner = b->mapped ? wr_try_alloc(faces, 3 * sizeof *b->corner, what, err) : NULL;
    if (!b->corner) return false;
    for (size_t i = 0; i < points; i++) /* -0 is 0 */
        for (int k = 0; k < 3; k++) b->points[i][k] = source->points[i][k] + 0.0f;
    return wr_weld(b->points, sizeof *b->points, source->point_count, b->at, &b->places, err);
}

static void end(WrTrianglesBuild *b)
{
    wr_free(b->points);
    wr_free(b->at);
    wr_free(b->own);
    wr_free(b->face);
    wr_free(b->of);
    wr_free(b->normal);
    wr_free(b->mapped);
    wr_free(b->corner);
}

static bool build(WrTrianglesBuild *b, WrError *err)
{
    if (!begin(b, err)) return false;
    keep_faces(b);
    if (b->count == 0) return wr_fail(err, "no triangle has an area");
    find_ball(b);
    b->closed = is_closed(b);
    take_normals(b);
    if (b->closed && volume(b) < 0) {
        turn_out(b);
        turn_normals(b);
    }
    if (!fill_normals(b, err)) return false;
    count_bad_uv(b);
    for (int32_t i = 0; i < b->count; i++) make_face(b, i);
    count_maps(b);
    return true;
}

WrTriangles *wr_triangles_new(const WrTrianglesSource *source, WrError *err)
{
    if (!check_source(source, err)) return NULL;
    WrTrianglesBuild b = { .source = source };
    WrTriangles *made = build(&b, err) ? wr_triangles_finish(&b, err) : NULL;
    end(&b);
    return made;
}

WrTriangles *wr_triangles_share(const WrTriangles *triangles)
{
    WrTriangles *shared = (WrTriangles *)triangles; /* only the reference count changes */
    __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_triangles_free(WrTriangles *triangles)
{
    if (!triangles || __atomic_sub_fetch(&triangles->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_free((void *)triangles->corners);
    wr_free((void *)triangles->triangles);
    wr_free((void *)triangles->parts);
    wr_patches_free(triangles->patches);
    wr_free(triangles);
}

WrTriangles *wr_triangles_square(void)
{
    static const float points[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
    static const float uv[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    static const int32_t corners[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } };
    const WrTrianglesSource source = {
        .points = points, .uv = uv, .corners = corners, .point_count = 4, .triangle_count = 2
    };
    return wr_triangles_new(&source, NULL);
}

int wr_triangles_part(const WrTriangles *triangles, int32_t i)
{
    int low = 0, high = triangles->part_count - 1;
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (triangles->parts[middle].first <= i) low = middle;
        else high = middle - 1;
    }
    return low;
}

bool wr_triangle_gradients(const WrVec3 p[3], const double uv[3][2], WrVec3 *normal, WrVec3 *grad_u,
                           WrVec3 *grad_v)
{
    const WrVec3 none = { 0, 0, 0 };
    int from;
    const WrVec3 cross = face_of(p, &from), n = v3_unit(cross, none);
    const double twice = v3_len(cross);
    const int a = from, b = (from + 1) % 3, c = (from + 2) % 3;
    /* the sum over edges needs only differences to the first corner */
    const WrVec3 eb = v3_sub(p[a], p[c]), ec = v3_sub(p[b], p[a]); /* opposite b and c */
    WrVec3 g[2];
    for (int k = 0; k < 2; k++) {
        const double db = uv[b][k] - uv[a][k], dc = uv[c][k] - uv[a][k];
        g[k] = v3_cross(n, v3_add(v3_scale(eb, db / twice), v3_scale(ec, dc / twice)));
    }
    if (!usable(cross) || !isfinite(v3_len(g[0])) || !isfinite(v3_len(g[1]))) return false;
    *normal = n, *grad_u = g[0], *grad_v = g[1];
    return true;
}
