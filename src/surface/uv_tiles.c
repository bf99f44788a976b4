#include "surface/uv_tiles.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

#define EDGE 1e-5 /* depth in (u,v) by which a triangle must reach into a tile */
#define LISTED 16 /* tiles of a text */
#define MANY                                                                                       \
    100 /* tiles of a bounding box: a larger triangle has a repeated texture, and is on none */
#define ROW_MAX 900 /* of WR_UDIM_LAST, and one more */

typedef struct Face {
    double u[3], v[3];
    int low[2], high[2]; /* columns and rows of its bounding box, within -1..10 and -1..ROW_MAX */
    bool mapped, wide;
} Face;

/* Column or row of the lower, or upper, end of a range; -1 and `most` + 1 stand for all beyond. */
static int cell_of(double x, bool upper, int most)
{
    const double cell = upper ? ceil(x - EDGE) - 1 : floor(x + EDGE);
    return (int)fmin(most + 1, fmax(-1, cell));
}

static Face face_of(const WrTriangles *mesh, int32_t triangle)
{
    Face face = { .mapped = false };
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = wr_triangle_corner(mesh, triangle, k);
        face.u[k] = (double)c->u, face.v[k] = (double)c->v;
        face.mapped |= c->u != 0 || c->v != 0; /* missing ones are 0 */
        low[0] = fmin(low[0], face.u[k]), high[0] = fmax(high[0], face.u[k]);
        low[1] = fmin(low[1], face.v[k]), high[1] = fmax(high[1], face.v[k]);
    }
    for (int k = 0; k < 2; k++) {
        const int most = k ? ROW_MAX - 1 : 9;
        face.low[k] = cell_of(low[k], false, most);
        face.high[k] = cell_of(high[k], true, most);
        if (face.high[k] < face.low[k]) face.high[k] = face.low[k]; /* narrower than EDGE */
    }
    face.wide = (face.high[0] - face.low[0] + 1) * (face.high[1] - face.low[1] + 1) > MANY;
    return face;
}

/* True if the triangle shares an area with a tile of its bounding box: no side has all of the tile, less its edge, on
   its outer side. */
static bool is_on(const Face *face, int column, int row)
{
    if (face->low[0] == face->high[0] && face->low[1] == face->high[1]) return true;
    const double area = (face->u[1] - face->u[0]) * (face->v[2] - face->v[0]) -
                        (face->u[2] - face->u[0]) * (face->v[1] - face->v[0]);
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3;
        const double sign = area < 0 ? -1 : 1;
        const double nu = -sign * (face->v[l] - face->v[k]), nv = sign * (face->u[l] - face->u[k]);
        /* the tile's corner that is farthest inwards */
        const double u = column + (nu > 0 ? 1 - EDGE : EDGE), v = row + (nv > 0 ? 1 - EDGE : EDGE);
        if (nu * (u - face->u[k]) + nv * (v - face->v[k]) < 0) return false;
    }
    return true;
}

static bool is_outside(const Face *face)
{
    return face->low[0] < 0 || face->high[0] > 9 || face->low[1] < 0 ||
           wr_udim_number(face->high[0], face->high[1]) == 0;
}

WrUvTiles wr_uv_tiles(const WrTriangles *mesh)
{
    WrUvTiles tiles = { .triangles = wr_alloc(WR_UDIM_COUNT, sizeof *tiles.triangles) };
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        const Face face = face_of(mesh, i);
        int on = 0;
        if (!face.mapped) continue;
        for (int row = face.low[1]; row <= face.high[1] && !face.wide; row++)
            for (int column = face.low[0]; column <= face.high[0]; column++) {
                const int number = wr_udim_number(column, row);
                if (number == 0 || !is_on(&face, column, row)) continue;
                tiles.triangles[number - WR_UDIM_FIRST]++;
                on++;
            }
        tiles.crossing += on > 1 || face.wide;
        tiles.outside += is_outside(&face);
    }
    for (int i = 0; i < WR_UDIM_COUNT; i++) tiles.count += tiles.triangles[i] > 0;
    return tiles;
}

void wr_uv_tiles_fini(WrUvTiles *tiles)
{
    wr_free(tiles->triangles);
    *tiles = (WrUvTiles){ 0 };
}

int wr_uv_tiles_numbers(const WrUvTiles *tiles, int *numbers, int most)
{
    int count = 0;
    for (int i = 0; i < WR_UDIM_COUNT && count < most; i++)
        if (tiles->triangles[i] > 0) numbers[count++] = WR_UDIM_FIRST + i;
    return count;
}

void wr_uv_tiles_print(const WrUvTiles *tiles, WrText *text)
{
    int numbers[LISTED];
    const int count = wr_uv_tiles_numbers(tiles, numbers, LISTED);
    for (int i = 0; i < count; i++)
        wr_text_addf(text, "%s%d (%d)", i ? ", " : "", numbers[i],
                     (int)tiles->triangles[numbers[i] - WR_UDIM_FIRST]);
    if (tiles->count > count) wr_text_add(text, ", ...");
}

/* ---- the mesh of one tile ---- */

typedef struct Work {
    const WrTriangles *mesh;
    float (*points)[3], (*normals)[3], (*uv)[2];
    int32_t *
        point_of; /* [2 corners] 1 + point of each corner with (u,v), then without them; 0: none yet */
    int32_t (*corners)[3];
    bool *on; /* [triangles] */
    WrTrianglePart parts[WR_TRIANGLE_PARTS_MAX];
    int32_t points_used, triangles, part_count;
} Work;

static bool hold(Work *w, WrError *err)
{
    const size_t points = 2 * (size_t)w->mesh->corner_count;
    const size_t triangles = (size_t)w->mesh->triangle_count;
    w->points = wr_try_alloc(points, sizeof *w->points, "a mesh", err);
    w->normals = w->points ? wr_try_alloc(points, sizeof *w->normals, "a mesh", err) : NULL;
    w->uv = w->normals ? wr_try_alloc(points, sizeof *w->uv, "a mesh", err) : NULL;
    w->point_of = w->uv ? wr_try_alloc(points, sizeof *w->point_of, "a mesh", err) : NULL;
    w->corners = w->point_of ? wr_try_alloc(triangles, sizeof *w->corners, "a mesh", err) : NULL;
    w->on = w->corners ? wr_try_alloc(triangles, sizeof *w->on, "a mesh", err) : NULL;
    return w->on != NULL;
}

static int32_t point_of(Work *w, int32_t corner, bool on)
{
    int32_t *of = &w->point_of[corner + (on ? 0 : w->mesh->corner_count)];
    if (*of > 0) return *of - 1;
    const WrTriangleCorner *c = &w->mesh->corners[corner];
    const int32_t i = w->points_used++;
    memcpy(w->points[i], c->p, sizeof c->p);
    memcpy(w->normals[i], c->n, sizeof c->n);
    w->uv[i][0] = on ? c->u : NAN;
    w->uv[i][1] = on ? c->v : NAN;
    *of = i + 1;
    return i;
}

/* Appends the triangles of part `index` that are, or are not, on the tile, as a part of their own. */
static bool add_part(Work *w, int index, bool on, WrError *err)
{
    const WrTrianglePart *part = &w->mesh->parts[index];
    WrTrianglePart own = *part;
    own.first = w->triangles;
    own.number = index + 1;
    for (int32_t i = part->first; i < part->first + part->count; i++) {
        if (w->on[i] != on) continue;
        for (int k = 0; k < 3; k++)
            w->corners[w->triangles][k] = point_of(w, w->mesh->triangles[i].corner[k], on);
        w->triangles++;
    }
    own.count = w->triangles - own.first;
    if (own.count == 0) return true;
    if (w->part_count == WR_TRIANGLE_PARTS_MAX)
        return wr_fail(err, "a mesh of %d parts is divided by its tiles into more than %d",
                       (int)w->mesh->part_count, WR_TRIANGLE_PARTS_MAX);
    w->parts[w->part_count++] = own;
    return true;
}

/* Marks the triangles on the tile; returns their number. */
static int32_t mark(Work *w, int number)
{
    const int column = wr_udim_column(number), row = wr_udim_row(number);
    int32_t count = 0;
    for (int32_t i = 0; i < w->mesh->triangle_count; i++) {
        const Face face = face_of(w->mesh, i);
        w->on[i] = face.mapped && !face.wide && column >= face.low[0] && column <= face.high[0] &&
                   row >= face.low[1] && row <= face.high[1] && is_on(&face, column, row);
        count += w->on[i];
    }
    return count;
}

static bool fail_empty(const WrTriangles *mesh, int number, WrError *err)
{
    WrUvTiles tiles = wr_uv_tiles(mesh);
    WrText text = { 0 };
    wr_uv_tiles_print(&tiles, &text);
    if (!mesh->mapped) wr_fail(err, "the mesh has no texture coordinates, and so no tiles");
    else if (tiles.count == 0)
        wr_fail(err,
                "no triangle of the mesh is on tile %d, or on any other: u must be 0 to 10, v 0 or "
                "more",
                number);
    else
        wr_fail(err, "no triangle of the mesh is on tile %d; triangles on others: %s", number,
                wr_text_get(&text));
    wr_text_fini(&text);
    wr_uv_tiles_fini(&tiles);
    return false;
}

WrTriangles *wr_triangles_of_tile(const WrTriangles *mesh, int number, WrError *err)
{
    Work *w = wr_alloc(1, sizeof *w);
    WrTriangles *made = NULL;
    w->mesh = mesh;
    bool good = hold(w, err) && (mark(w, number) > 0 || fail_empty(mesh, number, err));
    for (int i = 0; i < 2 * mesh->part_count && good; i++)
        good = add_part(w, i / 2, i % 2 == 0, err);
    if (good) {
        const WrTrianglesSource source = { .points = (const float(*)[3])w->points,
                                           .normals = (const float(*)[3])w->normals,
                                           .uv = (const float(*)[2])w->uv,
                                           .corners = (const int32_t(*)[3])w->corners,
                                           .point_count = w->points_used,
                                           .triangle_count = w->triangles,
                                           .parts = w->parts,
                                           .part_count = w->part_count };
        made = wr_triangles_new(&source, err);
    }
    wr_free(w->on);
    wr_free(w->corners);
    wr_free(w->point_of);
    wr_free(w->uv);
    wr_free(w->normals);
    wr_free(w->points);
    wr_free(w);
    return made;
}
