/* Maps on the canvas: after an edit the updated map equals a new one, and only affected tiles are computed. */
#include "test.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "ui/canvas/canvas_derived_map.h"

#include <SDL.h>

static uint32_t seed = 18;

static float next(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed / 4294967296.0);
}

static WrField *rough(int w, int h)
{
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0, NULL);
    for (int k = 0; k < w * h; k++) wr_field_set(field, k % w, k / w, next());
    return field;
}

static WrMapJob job_of(WrScheme scheme)
{
    const WrDerivatives ground = { NULL, NULL, scheme, 0.11, 1.5, 1 };
    WrMapJob job = wr_map_default(&ground);
    job.directions = 8, job.reach = 20, job.sigma = 3;
    return job;
}

static const WrField *rested(WrCanvasMap *map, const WrField *field, WrFieldMapKind kind,
                             const WrMapJob *job)
{
    wr_canvas_map_update(map, field, kind, job);
    while (wr_canvas_map_busy(map)) SDL_Delay(1);
    const WrField *made = wr_canvas_map_update(map, field, kind, job);
    assert_false(wr_canvas_map_busy(map));
    return made;
}

/* Bit-identical; curvature is per texel. */
static void is_that_of(const WrField *made, const WrField *field, WrFieldMapKind kind,
                       const WrMapJob *job)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const WrMapPart part = { 0, 0, w, h, (size_t)w };
    const double by = kind == WR_FIELD_MAP_CURVATURE ? 1.5 / w : 1;
    float *out = wr_alloc((size_t)w * (size_t)h, sizeof *out);
    WrMapJob own = *job;
    WrError err = { "" };
    own.ground.field = field;
    assert_true(wr_map_make(kind, &own, &part, NULL, out, NULL, &err));
    for (int k = 0; k < w * h; k++)
        assert_near(wr_field_get(made, k % w, k / w), by * (double)out[k],
                    kind == WR_FIELD_MAP_CAVITY ? 1e-6 : 1e-6 * fabs(by * (double)out[k]));
    wr_free(out);
}

static void edits_are_followed_in_as_few_tiles_as_they_reach(void **state)
{
    (void)state;
    const int places[][2] = { { 0, 0 }, { 250, 201 }, { 100, 130 }, { 319, 64 } };
    for (int kind = 0; kind < WR_FIELD_MAP_COUNT; kind++) {
        WrCanvasMap *map = wr_canvas_map_new(2, SDL_USEREVENT);
        const WrMapJob job = job_of(kind % 2 ? WR_SCHEME_BSPLINE_FIT : WR_SCHEME_CENTRAL);
        WrField *field = rough(321, 259);
        is_that_of(rested(map, field, (WrFieldMapKind)kind, &job), field, (WrFieldMapKind)kind,
                   &job);
        assert_int_equal(wr_canvas_map_tiles(map), 6 * 5);
        for (int n = 0; n < 4; n++) {
            const int64_t before = wr_canvas_map_tiles(map);
            wr_field_set(field, places[n][0], places[n][1], 3);
            const WrField *made = rested(map, field, (WrFieldMapKind)kind, &job);
            is_that_of(made, field, (WrFieldMapKind)kind, &job);
            assert_in_range(wr_canvas_map_tiles(map) - before, 1, 16);
        }
        wr_canvas_map_free(map);
        wr_field_free(field);
    }
}

/* Another kind, setting or size: a new map; the same request again: no work. */
static void what_is_asked_for_otherwise_is_made_anew(void **state)
{
    (void)state;
    WrCanvasMap *map = wr_canvas_map_new(1, SDL_USEREVENT);
    WrMapJob job = job_of(WR_SCHEME_CENTRAL);
    WrField *field = rough(65, 3), *other = rough(2, 3);
    is_that_of(rested(map, field, WR_FIELD_MAP_SLOPE, &job), field, WR_FIELD_MAP_SLOPE, &job);
    assert_null(wr_canvas_map_update(map, field, WR_FIELD_MAP_OCCLUSION, &job));
    is_that_of(rested(map, field, WR_FIELD_MAP_OCCLUSION, &job), field, WR_FIELD_MAP_OCCLUSION,
               &job);
    job.reach = 7;
    is_that_of(rested(map, field, WR_FIELD_MAP_OCCLUSION, &job), field, WR_FIELD_MAP_OCCLUSION,
               &job);
    const int64_t tiles = wr_canvas_map_tiles(map);
    rested(map, field, WR_FIELD_MAP_OCCLUSION, &job);
    assert_int_equal(wr_canvas_map_tiles(map), tiles);
    assert_null(wr_canvas_map_update(map, other, WR_FIELD_MAP_OCCLUSION, &job));
    is_that_of(rested(map, other, WR_FIELD_MAP_OCCLUSION, &job), other, WR_FIELD_MAP_OCCLUSION,
               &job);
    wr_canvas_map_free(map);
    wr_field_free(field), wr_field_free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_are_followed_in_as_few_tiles_as_they_reach),
        cmocka_unit_test(what_is_asked_for_otherwise_is_made_anew),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
