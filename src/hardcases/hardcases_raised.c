/* Hard cases of displaced surfaces. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/tessellation/dice.h"
#include "render/plan/plan.h"
#include "render/visibility/view.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <stdlib.h>
#include <string.h>

#define SIDE 72 /* pixels */
#define CASES 3

static WrScene *displaced_of(int k, double height, double dice)
{
    static const WrSurfaceKind kinds[CASES] = { WR_SURFACE_cube, WR_SURFACE_sphere,
                                                WR_SURFACE_torus };
    WrScene *scene = wr_scene_new();
    const WrShape shape = wr_hard_shape(kinds[k]);
    wr_scene_set_shape(scene, &shape);
    scene->displaced = true;
    scene->height = height;
    scene->dials.dice = dice;
    scene->replicate_u = k == 1 ? 1.43 : 2; /* the sphere's seam is not periodic */
    return scene;
}

/* An edge of a facet by the positions of its ends; way: its direction. */
typedef struct Edge {
    float end[2][3];
    int way;
} Edge;

static int compare_edges(const void *a, const void *b)
{
    return memcmp(((const Edge *)a)->end, ((const Edge *)b)->end, sizeof((const Edge *)a)->end);
}

static Edge edge_of(const float *from, const float *to)
{
    Edge edge = { .way = memcmp(from, to, 3 * sizeof *from) < 0 ? 1 : -1 };
    memcpy(edge.end[edge.way < 0], from, 3 * sizeof *from);
    memcpy(edge.end[edge.way > 0], to, 3 * sizeof *to);
    return edge;
}

/* Number of facet edges that do not occur equally often in both directions: each is a crack. */
static int cracks(const WrTriangles *t)
{
    const int32_t most = 3 * t->triangle_count;
    Edge *edges = wr_alloc((size_t)most, sizeof *edges);
    int32_t count = 0;
    int open = 0;
    for (int32_t i = 0; i < most; i++) {
        const int32_t *c = t->triangles[i / 3].corner;
        const float *from = t->corners[c[i % 3]].p, *to = t->corners[c[(i + 1) % 3]].p;
        if (memcmp(from, to, 3 * sizeof *from) != 0) edges[count++] = edge_of(from, to);
    }
    qsort(edges, (size_t)count, sizeof *edges, compare_edges);
    for (int32_t i = 0, end; i < count; i = end) {
        int sum = 0;
        for (end = i; end < count && compare_edges(&edges[i], &edges[end]) == 0; end++)
            sum += edges[end].way;
        open += sum != 0;
    }
    wr_free(edges);
    return open;
}

static bool look_for_cracks(WrHardGauge *g, const WrFrameRequest *request, WrError *err)
{
    const WrScene *scene = request->scene;
    WrHardShot shot;
    WrView view = { 0 };
    WrDice made = { 0 };
    if (!wr_hard_shoot(g, request, &shot, err)) return false;
    const bool good =
        wr_view_init(&view, scene, wr_shape_radius(&scene->shape), shot.frame.plan,
                     request->turn_deg, SIDE, SIDE, err) &&
        wr_dice_make(&made, scene, request->field, &view, scene->dials.dice, g->pool, err);
    if (good) wr_hard_off(g, WR_HARD_FLOAT, cracks(made.triangles));
    wr_dice_fini(&made);
    wr_view_fini(&view);
    wr_hard_put_away(&shot);
    return good;
}

static bool hc124(WrHardGauge *g, WrError *err)
{
    static const double rates[] = { 16, 4, 1.7, 0.5 };
    WrField *field = wr_hard_rough(g, 11, 7, WR_WRAP_PERIODIC);
    bool good = true;
    for (int k = 0; k < 4 * CASES && good; k++) {
        WrScene *scene = displaced_of(k % CASES, 0.13, rates[k / CASES]);
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIDE, .height = SIDE, .turn_deg = 22
        };
        good = look_for_cracks(g, &request, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* All values are finite, by facets and by the reference. If the number of facets reaches its limit, that is
   reported, and the second arithmetic, which uses the same facets, is skipped. */
static bool ends(WrHardGauge *g, const WrFrameRequest *request, bool endless, WrError *err)
{
    WrReference truth = { 0 };
    bool good = wr_hard_refer(g, request, 1, &truth, err);
    if (good) wr_hard_off(g, WR_HARD_DOUBLE, (double)wr_hard_wild_reference(&truth));
    for (int way = 0; way < (endless ? 1 : WR_HARD_WAYS) && good; way++) {
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        WrHardShot shot;
        good = wr_hard_shoot_by(g, request, (WrHardWay)way, &shot, err);
        if (!good) break;
        const char *why = shot.frame.plan->rows[WR_EFFECT_DISPLACED].reason;
        wr_hard_off(g, precision, (double)wr_hard_wild(&shot));
        wr_hard_holds(g, precision, !endless || strstr(why, "as many as there may be"));
        wr_hard_put_away(&shot);
    }
    wr_reference_fini(&truth);
    return good;
}

static bool hc125(WrHardGauge *g, WrError *err)
{
    WrField *level = wr_field_new(4, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1, err);
    WrField *rough = wr_hard_rough(g, 31, 17, WR_WRAP_PERIODIC);
    bool good = level != NULL;
    for (int k = 0; k < 2 && good; k++) {
        WrScene *scene = displaced_of(1, k == 0 ? -1 : 1e6, 0.5);
        scene->shape.value[0] = 1;
        scene->displaced = false;
        wr_scene_hold_camera(scene, scene, 1); /* the base's camera: from inside, not from afar */
        scene->displaced = true;
        const WrFrameRequest request = {
            .field = k == 0 ? level : rough, .scene = scene, .width = 9, .height = 9
        };
        good = ends(g, &request, k == 1, err);
        wr_scene_free(scene);
    }
    wr_field_free(level);
    wr_field_free(rough);
    return good;
}

#define DISPLACED "table 11x7\ndab 0.3,0.4 radius=3 strength=1\nreplicate 1.43,1\n"
static const WrHardCase rows[] = {
    { .id = "HC124",
      .subject = WR_HARD_RENDER,
      .what = "edges of a displaced cube, poles and an open seam of a displaced sphere",
      .holds = "each edge of a facet is that of another the other way round, at four rates",
      .unit = "edges without",
      .bound = { 0, NAN },
      .measure = hc124,
      .scene = DISPLACED "surface sphere\nbump height=0.2 displaced=on" },
    { .id = "HC125",
      .subject = WR_HARD_RENDER,
      .what = "a sphere displaced to its middle, and by a million",
      .holds = "every value is a number; facets end at their limit, and it is said",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc125,
      .scene = DISPLACED "surface sphere\nbump height=1e6 displaced=on" },
};
WR_HARD_LIST(raised, rows);
