/* Sets of bicubic patches: files, connectivity, tessellation, and the table on them. */
#include "test.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/scheme.h"
#include "field/wrap.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "surface/terrain.h"

#include "patch_sets.h"

#include <math.h>
#include <string.h>

static WrTriangles *make(const float (*points)[48], int32_t count, WrPatchTable table)
{
    WrError err = { "" };
    WrTriangles *made = wr_patches_new(points, count, table, &err);
    if (!made) fail_msg("%s", err.text);
    return made;
}

static WrTriangles *teapot(bool slip, WrPatchTable table)
{
    float(*points)[48];
    int32_t count;
    points = teapot_points(&count);
    if (slip) { /* as in a circulating copy: patch 12 has 1.2 for 1.12 */
        int found = 0;
        for (int i = 0; i < 16; i++) {
            float *p = points[11] + 3 * i;
            if (p[0] != 2.0f || p[1] != 1.12f || p[2] != 0.45f) continue;
            p[1] = 1.2f;
            found++;
        }
        assert_int_equal(found, 1);
    }
    WrTriangles *made = make((const float(*)[48])points, count, table);
    wr_free(points);
    return made;
}

/* ---- connectivity ---- */

/* HC152: note on the open edges and degenerate patches of Newell's teapot. */
static void the_teapot_is_told_of(void **state)
{
    (void)state;
    WrTriangles *pot = teapot(false, WR_PATCH_EACH), *slipped = teapot(true, WR_PATCH_EACH);
    const WrPatchesReport *report = &pot->patches->report, *slip = &slipped->patches->report;
    assert_int_equal(pot->patches->count, 32);
    assert_int_equal(report->shared, 52);
    assert_int_equal(report->open, 16);
    assert_int_equal(report->loops, 6);
    assert_int_equal(report->collapsed, 8);
    assert_int_equal(report->crowded + report->against + report->turned, 0);
    assert_int_equal(report->creased, 0);
    assert_int_equal(slip->creased, 1);
    assert_near(slip->crease_deg, 2.70, 0.01);
    assert_int_equal(slip->crease_of[0], 7);
    assert_int_equal(slip->crease_of[1], 11);
    assert_false(pot->closed);
    wr_triangles_free(pot);
    wr_triangles_free(slipped);
}

/* HC85: triangles of neighbouring patches have the same corners along the common edge, so that no sample is lost:
   every edge that belongs to one triangle is on an open edge. The teapot, with different subdivision on both
   sides. */
static void neighbours_are_cut_alike(void **state)
{
    (void)state;
    WrTriangles *pot = teapot(false, WR_PATCH_EACH);
    float(*place)[3] = wr_alloc((size_t)pot->corner_count, sizeof *place);
    for (int32_t i = 0; i < pot->corner_count; i++)
        memcpy(place[i], pot->corners[i].p, sizeof *place);
    /* the sum over all directed edges, of a hash that changes sign with the direction, leaves only open ones */
    double sum[3] = { 0, 0, 0 }, alone = 0;
    for (int32_t i = 0; i < pot->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            const float *a = place[pot->triangles[i].corner[k]];
            const float *b = place[pot->triangles[i].corner[(k + 1) % 3]];
            const WrVec3 p = { (double)a[0], (double)a[1], (double)a[2] };
            const WrVec3 q = { (double)b[0], (double)b[1], (double)b[2] };
            const WrVec3 n = v3_cross(p, q);
            sum[0] += n.x, sum[1] += n.y, sum[2] += n.z;
            alone += fabs(n.x);
        }
    /* the same for the loops: rim and lid are circles about the axis, of radius 1.4 and 1.3; spout and handle are in
       planes */
    double want[3] = { 0, 0, 0 };
    const WrPatches *set = pot->patches;
    for (int32_t i = 0; i < set->count; i++)
        for (int k = 0; k < 4; k++) {
            if (!patch_edge_is_open(set, i, k)) continue;
            const int cuts = (int)lround(
                1 / (k < 2 ? (double)set->patch[i].reach_u : (double)set->patch[i].reach_v));
            for (int j = 0; j < cuts; j++) {
                WrVec3 a = patch_on_edge(set->patch[i].point, k, (double)j / cuts);
                WrVec3 b = patch_on_edge(set->patch[i].point, k, (double)(j + 1) / cuts);
                const WrVec3 n = k == 0 || k == 3 ? v3_cross(a, b) : v3_cross(b, a);
                want[0] += n.x, want[1] += n.y, want[2] += n.z;
            }
        }
    for (int k = 0; k < 3; k++) assert_near(sum[k], want[k], 1e-5);
    assert_true(alone > 10);
    wr_free(place);
    wr_triangles_free(pot);
}

/* Over the whole of every patch the triangles and their (u,v) are within the stated distance. */
static void triangles_are_near(void **state)
{
    (void)state;
    WrTriangles *pot = teapot(false, WR_PATCH_EACH);
    const double off = 1.001 * WR_PATCH_OFF * pot->radius;
    double worst = 0;
    for (int32_t i = 0; i < pot->triangle_count; i += 7) {
        const WrPatch *patch = &pot->patches->patch[pot->patches->of[i]];
        WrVec3 mid = { 0, 0, 0 };
        double u = 0, v = 0;
        for (int k = 0; k < 3; k++) {
            const WrTriangleCorner *c = &pot->corners[pot->triangles[i].corner[k]];
            mid = v3_add(mid,
                         (WrVec3){ (double)c->p[0] / 3, (double)c->p[1] / 3, (double)c->p[2] / 3 });
            u += (double)c->u / 3, v += (double)c->v / 3;
        }
        worst = fmax(worst, v3_len(v3_sub(patch_at(patch->point, u, v).p, mid)));
    }
    assert_true(worst < off && worst > 0.02 * off);
    wr_triangles_free(pot);
}

/* ---- joined tables ---- */

static const struct {
    int turn;
    bool mirror;
} ways[] = { { 0, false }, { 1, false }, { 2, false }, { 3, false },
             { 0, true },  { 1, true },  { 2, true },  { 3, true } };

/* F and its gradient on the surface, for the table on the patch. */
static void on_patch(const WrPatches *set, int32_t i, double u, double v, const WrField *field,
                     WrScheme scheme, double *f, WrVec3 *grad)
{
    const WrPatch *patch = &set->patch[i];
    const WrSurfacePoint at = patch_at(patch->point, u, v);
    const float *c = patch->chart;
    double tu, tv;
    wr_patch_chart(set, patch, u, v, &tu, &tv);
    double fs, ft;
    wr_field_sample(field, scheme, 1, &tu, &tv, f, &fs, &ft);
    const WrVec3 gu = v3_scale(v3_cross(at.pv, at.n_unit), 1 / at.n_len);
    const WrVec3 gv = v3_scale(v3_cross(at.n_unit, at.pu), 1 / at.n_len);
    const double fu = fs * (double)c[1] * set->scale_u + ft * (double)c[4] * set->scale_v;
    const double fv = fs * (double)c[2] * set->scale_u + ft * (double)c[5] * set->scale_v;
    *grad = v3_add(v3_scale(gu, fu), v3_scale(gv, fv));
}

/* HC151: a patch divided into four, some rotated by quarters, some mirrored: F is bit-identical on both sides of each
   common edge and its gradient is equal, whether each part has the whole table or a quarter. */
static void the_table_runs_on(void **state)
{
    (void)state;
    WrField *field = wr_field_new(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    TestRandom random = { 5 };
    for (int i = 0; i < 256; i++) wr_field_set(field, i % 16, i / 16, (float)test_random(&random));
    for (int round = 0; round < 16; round++) {
        const WrPatchTable table = round % 2 ? WR_PATCH_SPLIT : WR_PATCH_JOINED;
        float points[4][48];
        quarter(wavy_patch, points);
        for (int k = 0; k < 4; k++) {
            const int way = (k * 3 + round / 2 + k * round) % 8;
            turn_points(points[k], ways[way].turn, ways[way].mirror);
        }
        WrTriangles *made = make((const float(*)[48])points, 4, table);
        const WrPatches *set = made->patches;
        assert_int_equal(set->report.shared, 4);
        assert_int_equal(set->report.joined, 4);
        assert_int_equal(set->report.against, 0);
        int met = 0;
        for (int32_t a = 0; a < 16; a++)
            for (int32_t b = a + 1; b < 16; b++) {
                bool turned;
                if (a / 4 == b / 4 || !same_edge(set, a, b, &turned)) continue;
                met++;
                for (int k = 0; k <= 32; k++) {
                    const double t = k / 32.0, s = turned ? 1 - t : t;
                    double f[2], at[2][2];
                    WrVec3 g[2];
                    edge_uv(a % 4, t, at[0]);
                    edge_uv(b % 4, s, at[1]);
                    on_patch(set, a / 4, at[0][0], at[0][1], field, WR_SCHEME_BSPLINE, &f[0],
                             &g[0]);
                    on_patch(set, b / 4, at[1][0], at[1][1], field, WR_SCHEME_BSPLINE, &f[1],
                             &g[1]);
                    assert_memory_equal(&f[0], &f[1], sizeof f[0]);
                    /* the quarters' points are rounded to floats */
                    const double off = v3_len(v3_sub(g[0], g[1])), most = v3_len(g[0]) + 1;
                    if (!(off < 1e-6 * most)) fail_msg("gradients %g of %g apart", off, most);
                }
            }
        assert_int_equal(met, 4);
        wr_triangles_free(made);
    }
    wr_field_free(field);
}

/* Separate cells with margins: no tap of a cubic scheme in a cell of 64 texels reaches another cell. */
static void cells_are_apart(void **state)
{
    (void)state;
    WrTriangles *pot = teapot(false, WR_PATCH_OWN);
    const WrPatches *set = pot->patches;
    assert_int_equal(set->columns, 6);
    assert_int_equal(set->rows, 6);
    for (int32_t i = 0; i < set->count; i++)
        for (int k = 0; k < 4; k++) {
            double u, v;
            wr_patch_chart(set, &set->patch[i], k % 2, k / 2, &u, &v);
            const double x = 64 * (u * set->columns - i % 6), y = 64 * (v * set->rows - i / 6);
            assert_near(x, k % 2 ? 62 : 2, 1e-9);
            assert_near(y, k / 2 ? 62 : 2, 1e-9);
        }
    wr_triangles_free(pot);
}

/* A terrain of patches equals the spline through the picture's means: level where that is level, evenly tilted where
   it is tilted; smooth across patches. */
static void terrains_are_smooth(void **state)
{
    (void)state;
    float level[12 * 8], ramp[12 * 8], rough[12 * 8];
    TestRandom random = { 3 };
    for (int i = 0; i < 96; i++) {
        level[i] = 0.5f, ramp[i] = (float)(i % 12) / 12, rough[i] = (float)test_random(&random);
    }
    const float *const all[] = { level, ramp, rough };
    for (int k = 0; k < 3; k++) {
        const WrTerrain terrain = {
            .ctx = all[k], .w = 12, .h = 8, .a = 3, .b = 2, .height = 0.5, .cells = 12
        };
        WrError err = { "" };
        float(*points)[48];
        int columns, rows;
        assert_true(wr_terrain_points(&terrain, &points, &columns, &rows, &err));
        assert_int_equal(columns, 12);
        assert_int_equal(rows, 8);
        WrTriangles *made = make((const float(*)[48])points, 96, WR_PATCH_SPLIT);
        const WrPatchesReport *report = &made->patches->report;
        assert_int_equal(report->shared, 11 * 8 + 12 * 7);
        assert_int_equal(report->joined, report->shared);
        assert_int_equal(report->loops, 1);
        assert_int_equal(report->creased + report->turned, 0);
        assert_int_equal(made->patches->columns, 12);
        for (int i = 0; i < 40;
             i++) { /* its point by its own u and v: derivatives are differences */
            const double u = 0.02 + 0.024 * i, v = 0.97 - 0.023 * i, e = 1e-6;
            WrSurfacePoint at, east, north;
            wr_terrain_at(made->patches, u, v, &at);
            wr_terrain_at(made->patches, u + e, v, &east);
            wr_terrain_at(made->patches, u, v + e, &north);
            assert_near(at.p.x, 3 * u, 1e-6);
            assert_near(at.p.y, 2 * v, 1e-6);
            assert_near(v3_len(v3_sub(v3_sub(east.p, at.p), v3_scale(at.pu, e))), 0, 1e-10);
            assert_near(v3_len(v3_sub(v3_sub(north.p, at.p), v3_scale(at.pv, e))), 0, 1e-10);
            assert_near(v3_len(v3_sub(v3_sub(north.pu, at.pu), v3_scale(at.puv, e))), 0, 1e-8);
            assert_near(v3_len(v3_sub(v3_sub(east.n_unit, at.n_unit), v3_scale(at.n_u, e))), 0,
                        1e-8);
            assert_near(v3_len(v3_sub(v3_cross(at.pu, at.pv), at.n)), 0, 1e-9);
        }
        const WrSurfacePoint mid = patch_at(points[12 * 4 + 6], 0, 0);
        assert_near(mid.p.x, 1.5, 1e-6);
        assert_near(mid.p.y, 1, 1e-6);
        if (k == 0) assert_near(mid.p.z, 0.25, 1e-6);
        if (k == 1) assert_near(mid.n_unit.x / mid.n_unit.z, -0.5 / 3, 1e-5);
        double u, v;
        wr_patch_chart(made->patches, &made->patches->patch[12 * 4 + 6], 0, 0, &u, &v);
        assert_near(u, 0.5, 1e-9);
        assert_near(v, 0.5, 1e-9);
        wr_free(points);
        wr_triangles_free(made);
    }
}

/* ---- texts ---- */

static bool parse(const char *text, WrError *err)
{
    float(*points)[48];
    int32_t count;
    if (!wr_patches_parse(text, strlen(text), &points, &count, err)) return false;
    wr_free(points);
    return true;
}

static void texts_are_read_or_told(void **state)
{
    (void)state;
    static const char head[] = "1\n3 3\n",
                      list[] = "1\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\n16\n";
    char text[1000] = "# a patch\n1 # one\n3 3\n", classic[1000];
    snprintf(classic, sizeof classic, "%s", list);
    for (int k = 0; k < 16; k++) {
        char point[40];
        snprintf(point, sizeof point, "%d %d %d\n", k % 4, k / 4, k % 3);
        strcat(text, point);
        snprintf(point, sizeof point, "%d,%d,%d\n", k % 4, k / 4, k % 3);
        strcat(classic, point);
    }
    WrError err = { "" };
    float(*a)[48], (*b)[48];
    int32_t count;
    assert_true(wr_patches_parse(text, strlen(text), &a, &count, &err));
    assert_true(wr_patches_parse(classic, strlen(classic), &b, &count, &err));
    assert_int_equal(count, 1);
    assert_memory_equal(a, b, sizeof *a);
    wr_free(a);
    wr_free(b);
    static const struct {
        const char *text, *report;
    } bad[] = {
        { "", "line 1: the file ends" },
        { "0\n", "\"0\" is not the count of patches, 1..4096" },
        { "99999999\n", "the count of patches" },
        { "teapot", "\"teapot\" is not the count" },
        { "1\n2 3\n", "line 2: \"2\" is not a degree of patch 1, 3..3" },
        { "1\n3 3\n0 0 x\n", "line 3: \"x\" is not a coordinate" },
        { "1\n3 3\n0 0 1e40\n", "line 3: \"1e40\" is not a coordinate" },
        { "1\n3 3\n0 0 nan\n", "\"nan\"" },
        { "1\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 0\n",
          "line 2: \"0\" is not the number of a point" },
        { "1\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n15\n",
          "line 3: 15 points, but a patch refers" },
        { head, "line 3: the file ends before a coordinate" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_false(parse(bad[i].text, &err));
        if (!strstr(err.text, bad[i].report)) fail_msg("%s: %s", bad[i].report, err.text);
    }
    strcat(text, "1\n");
    assert_false(parse(text, &err));
    assert_non_null(strstr(err.text, "line 20: \"1\" is not expected"));
}

/* Any bytes are refused with a message, or give a set with finite points. */
static void hostile_texts_end(void **state)
{
    (void)state;
    TestRandom random = { 11 };
    static const char letters[] = "0123456789 \n,.-+e#3 3 3 \n\n";
    char *good;
    size_t length;
    WrError err = { "" };
    assert_true(wr_file_read(WR_SOURCE_DIR "/samples/teapot.bpt", 1 << 20, &good, &length, &err));
    for (int round = 0; round < 300; round++) {
        float(*points)[48];
        int32_t count;
        char *text = wr_alloc(length, 1);
        memcpy(text, good, length);
        const size_t cut = round % 3 ? length : (size_t)((double)length * test_random(&random));
        for (int k = 0; k < round % 20; k++)
            text[(size_t)((double)length * test_random(&random))] =
                letters[(size_t)(test_random(&random) * (sizeof letters - 1))];
        if (wr_patches_parse(text, cut, &points, &count, &err)) {
            assert_true(count >= 1 && count <= WR_PATCHES_MAX);
            for (int32_t i = 0; i < 48 * count; i++) assert_true(isfinite(points[i / 48][i % 48]));
            wr_free(points);
        } else {
            assert_true(strlen(err.text) > 10);
        }
        wr_free(text);
    }
    wr_free(good);
}

/* Sets that are empty, a line, a point, huge, or one patch repeated: a message or a set, never a crash. */
static void odd_sets_end(void **state)
{
    (void)state;
    for (int round = 0; round < 7; round++) {
        float points[3][48];
        WrError err = { "" };
        for (int i = 0; i < 144; i++)
            points[i / 48][i % 48] = round == 0   ? 0
                                     : round == 1 ? (i % 3 == 0 ? (float)(i % 48) : 0)
                                     : round == 2 ? wavy_patch[i % 48] * 1e30f / 4
                                     : round == 3 ? wavy_patch[i % 48]
                                     : round == 4 ? wavy_patch[i % 48] * 1e-30f
                                     : round == 5 ? (i % 48 < 3 ? 1e30f : wavy_patch[i % 48])
                                                  : (float)((i * 7919) % 13);
        for (int table = 0; table < WR_PATCH_TABLES; table++) {
            WrTriangles *made =
                wr_patches_new((const float(*)[48])points, 3, (WrPatchTable)table, &err);
            if (!made) {
                assert_non_null(strstr(err.text, "area"));
                assert_true(round < 2);
                continue;
            }
            assert_true(made->triangle_count <= WR_PATCH_TRIANGLES);
            size_t count;
            float *block = wr_triangles_serialize(made, &count);
            WrTriangles *again = wr_triangles_deserialize(block, count, &err);
            assert_non_null(again);
            assert_true(again->key == made->key);
            block[1] = 5000;
            assert_null(wr_triangles_deserialize(block, count, &err));
            wr_free(block);
            wr_triangles_free(again);
            wr_triangles_free(made);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_teapot_is_told_of),  cmocka_unit_test(neighbours_are_cut_alike),
        cmocka_unit_test(triangles_are_near),     cmocka_unit_test(the_table_runs_on),
        cmocka_unit_test(cells_are_apart),        cmocka_unit_test(terrains_are_smooth),
        cmocka_unit_test(texts_are_read_or_told), cmocka_unit_test(hostile_texts_end),
        cmocka_unit_test(odd_sets_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
