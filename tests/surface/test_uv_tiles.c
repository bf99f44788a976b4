/* UDIM tiles of a mesh: which triangles lie on them by points in each triangle, and the mesh of one tile. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"
#include "base/udim.h"
#include "surface/triangles.h"
#include "surface/uv_tiles.h"

#include <math.h>
#include <string.h>

enum { COUNT = 300, GRID = 40 };

/* Separate triangles in space, with (u,v) from -1 on; every third is small. */
typedef struct Source {
    float points[3 * COUNT][3], uv[3 * COUNT][2];
    int32_t corners[COUNT][3];
} Source;

static uint64_t random_state = 7;

static double random_number(void)
{
    random_state = random_state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(random_state >> 40) * 0x1p-24;
}

static WrTriangles *random_mesh(Source *s)
{
    WrError err = { "" };
    static const WrTrianglePart parts[] = { { .name = "one", .first = 0, .count = 100 },
                                            { .name = "two", .first = 100, .count = COUNT - 100 } };
    for (int i = 0; i < 3 * COUNT; i++) {
        const int triangle = i / 3, k = i % 3;
        const double size = triangle % 3 ? 1.7 : 0.1;
        static double at[2];
        if (k == 0) at[0] = 12 * random_number() - 1, at[1] = 5 * random_number() - 1;
        for (int c = 0; c < 2; c++) s->uv[i][c] = (float)(at[c] + size * random_number());
        s->points[i][0] = (float)(triangle + (k == 1)), s->points[i][1] = (float)(k == 2);
        s->corners[triangle][k] = i;
    }
    const WrTrianglesSource source = { .points = (const float(*)[3])s->points,
                                       .uv = (const float(*)[2])s->uv,
                                       .corners = (const int32_t(*)[3])s->corners,
                                       .point_count = 3 * COUNT,
                                       .triangle_count = COUNT,
                                       .parts = parts,
                                       .part_count = 2 };
    WrTriangles *mesh = wr_triangles_new(&source, &err);
    if (!mesh) fail_msg("%s", err.text);
    return mesh;
}

/* Share of a triangle's points that are on a tile, column and row. */
static double share_on(const float (*uv)[2], int column, int row)
{
    int on = 0, all = 0;
    for (int i = 0; i <= GRID; i++)
        for (int j = 0; i + j <= GRID; j++, all++) {
            const double a = (double)i / GRID, b = (double)j / GRID, c = 1 - a - b;
            const double u = a * (double)uv[0][0] + b * (double)uv[1][0] + c * (double)uv[2][0];
            const double v = a * (double)uv[0][1] + b * (double)uv[1][1] + c * (double)uv[2][1];
            on += u > column && u < column + 1 && v > row && v < row + 1;
        }
    return (double)on / all;
}

/* A triangle with points on a tile counts there; one that counts without such points reaches in by little, which few
   do. */
static void triangles_lie_where_their_points_are(void **state)
{
    (void)state;
    Source s;
    WrTriangles *mesh = random_mesh(&s);
    WrUvTiles tiles = wr_uv_tiles(mesh);
    int least[WR_UDIM_COUNT] = { 0 }, outside = 0, crossing = 0, sum = 0, slack = 0;
    for (int t = 0; t < COUNT; t++) {
        const float(*uv)[2] = (const float(*)[2])s.uv + 3 * t;
        int on = 0;
        bool out = false;
        for (int row = 0; row < 6; row++)
            for (int column = 0; column < 10; column++) {
                if (share_on(uv, column, row) == 0) continue;
                least[10 * row + column]++;
                on++;
            }
        for (int k = 0; k < 3; k++) out = out || uv[k][0] < 0 || uv[k][0] > 10 || uv[k][1] < 0;
        outside += out, crossing += on > 1;
    }
    for (int i = 0; i < WR_UDIM_COUNT; i++) {
        assert_true(tiles.triangles[i] >= least[i]);
        sum += least[i], slack += (int)tiles.triangles[i] - least[i];
    }
    assert_true(sum > 300 && slack < sum / 50);
    assert_int_equal(tiles.outside, outside);
    assert_true(tiles.crossing >= crossing && tiles.crossing < crossing + sum / 50);
    wr_uv_tiles_fini(&tiles);
    wr_triangles_free(mesh);
}

/* The mesh of a tile has all triangles; those that are on it have their (u,v), the others none. */
static void a_tiles_mesh_has_its_coordinates(void **state)
{
    (void)state;
    Source s;
    WrError err = { "" };
    WrTriangles *mesh = random_mesh(&s);
    WrUvTiles tiles = wr_uv_tiles(mesh);
    const int number = 1001 + 4 + 10 * 3;
    WrTriangles *tile = wr_triangles_of_tile(mesh, number, &err);
    if (!tile) fail_msg("%s", err.text);
    assert_int_equal(tile->triangle_count, COUNT);
    assert_int_equal(tile->part_count, 4); /* the two, divided */
    int mapped = 0, seen = 0;
    for (int p = 0; p < tile->part_count; p++) {
        const WrTrianglePart *part = &tile->parts[p];
        assert_string_equal(part->name, p < 2 ? "one" : "two");
        assert_true(part->mapped == (p % 2 == 0));
        for (int i = part->first; i < part->first + part->count; i++) {
            const WrTriangleCorner *c[3];
            for (int k = 0; k < 3; k++) c[k] = &tile->corners[tile->triangles[i].corner[k]];
            const int t =
                (int)fmin((double)c[0]->p[0], fmin((double)c[1]->p[0], (double)c[2]->p[0]));
            const float(*uv)[2] = (const float(*)[2])s.uv + 3 * t;
            assert_true((t < 100) == (p < 2));
            for (int k = 0; k < 3; k++) {
                const int from = c[k]->p[1] > 0 ? 2 : (int)c[k]->p[0] - t;
                assert_true(c[k]->u == (part->mapped ? uv[from][0] : 0));
                assert_true(c[k]->v == (part->mapped ? uv[from][1] : 0));
            }
            if (share_on(uv, 4, 3) > 0) assert_true(part->mapped), seen++;
            mapped += part->mapped;
        }
    }
    assert_int_equal(mapped, tiles.triangles[number - WR_UDIM_FIRST]);
    assert_true(seen > 0);
    assert_null(wr_triangles_of_tile(mesh, 9999, &err));
    assert_non_null(strstr(err.text, "no triangle of the mesh is on tile 9999"));
    wr_triangles_free(tile);
    wr_uv_tiles_fini(&tiles);
    wr_triangles_free(mesh);
}

static WrUvTiles tiles_of(const float uv[3][2])
{
    static const float points[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    static const int32_t corners[1][3] = { { 0, 1, 2 } };
    const WrTrianglesSource source = {
        .points = points, .uv = uv, .corners = corners, .point_count = 3, .triangle_count = 1
    };
    WrTriangles *mesh = wr_triangles_new(&source, NULL);
    WrUvTiles tiles = wr_uv_tiles(mesh);
    wr_triangles_free(mesh);
    return tiles;
}

static void check(const float uv[3][2], const char *want, int crossing, int outside)
{
    WrText text = { 0 };
    WrUvTiles tiles = tiles_of(uv);
    wr_uv_tiles_print(&tiles, &text);
    assert_string_equal(wr_text_get(&text), want);
    assert_int_equal(tiles.crossing, crossing);
    assert_int_equal(tiles.outside, outside);
    wr_text_fini(&text);
    wr_uv_tiles_fini(&tiles);
}

/* Edges of tiles belong to both; rounding does not cross them. */
static void edges_and_ends(void **state)
{
    (void)state;
    check((const float[3][2]){ { 1, 1 }, { 2, 1 }, { 1, 2 } }, "1012 (1)", 0, 0);
    check((const float[3][2]){ { 1.000004f, 1 }, { 0, 1 }, { 0.5f, 2.000003f } }, "1011 (1)", 0, 0);
    check((const float[3][2]){ { 1.0001f, 0 }, { 0, 0 }, { 0.5f, 0.5f } }, "1001 (1), 1002 (1)", 1,
          0);
    /* a diagonal past the corner of 1012 and 1001 */
    check((const float[3][2]){ { 0.2f, 1.9f }, { 1.9f, 0.2f }, { 1.9f, 0.1f } },
          "1002 (1), 1011 (1), 1012 (1)", 1, 0);
    check((const float[3][2]){ { 9.1f, 0.5f }, { 9.9f, 0.5f }, { 9.5f, 0.9f } }, "1010 (1)", 0, 0);
    check((const float[3][2]){ { 10.1f, 0.5f }, { 10.9f, 0.5f }, { 10.5f, 0.9f } }, "", 0, 1);
    check((const float[3][2]){ { 0.1f, -0.5f }, { 0.9f, -0.5f }, { 0.5f, -0.1f } }, "", 0, 1);
    check((const float[3][2]){ { 0.1f, 901 }, { 0.9f, 901 }, { 0.5f, 901.5f } }, "", 0, 1);
    check((const float[3][2]){ { 0, 0 }, { 400, 0 }, { 0, 400 } }, "", 1, 1);
    check((const float[3][2]){ { NAN, NAN }, { NAN, NAN }, { NAN, NAN } }, "", 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_lie_where_their_points_are),
        cmocka_unit_test(a_tiles_mesh_has_its_coordinates),
        cmocka_unit_test(edges_and_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
