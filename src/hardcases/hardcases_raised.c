/* Hard cases of displaced surfaces. */
#include "hardcases/hardcases_inner.h"

#include "base/error.h"
#include "field/field.h"
#include "render/plan.h"
#include "scene/scene.h"

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
    scene->replicate_u = k == 1 ? 1.43 : 2; /* the ball's seam does not close */
    return scene;
}

/* Does the reference see the body all about that pixel, as far as facets may be off, and one pixel farther? */
static bool is_inside(const WrReference *truth, int x, int y, int far)
{
    if (x < far || y < far || x + far >= SIDE || y + far >= SIDE) return false;
    for (int j = y - far; j <= y + far; j++)
        for (int i = x - far; i <= x + far; i++)
            if (!(truth->rgba[4 * (j * SIDE + i) + 3] > 0)) return false;
    return true;
}

/* Pixels inside that show none of the body. */
static int64_t holes_of(const WrFrame *frame, const WrReference *truth, int far)
{
    int64_t holes = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        holes += !(frame->rgba[4 * i + 3] > 0) && is_inside(truth, i % SIDE, i / SIDE, far);
    return holes;
}

static bool look_for_holes(WrHardGauge *g, WrFrameRequest *request, WrError *err)
{
    WrReference truth = { 0 };
    const int far = 1 + (int)ceil(request->scene->dials.dice);
    bool good = wr_hard_refer(g, request, 1, &truth, err);
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        const WrHardPrecision precision = way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
        WrHardShot shot;
        good = wr_hard_shoot_by(g, request, (WrHardWay)way, &shot, err);
        if (!good) break;
        wr_hard_off(g, precision, (double)holes_of(&shot.frame, &truth, far));
        wr_hard_put_away(&shot);
    }
    wr_reference_fini(&truth);
    return good;
}

static bool hc124(WrHardGauge *g, WrError *err)
{
    static const double rates[] = { 3, 1.3, 0.7, 0.25 };
    WrField *field = wr_hard_rough(g, 11, 7, WR_WRAP_PERIODIC);
    bool good = true;
    for (int k = 0; k < 4 * CASES && good; k++) {
        WrScene *scene = displaced_of(k % CASES, 0.13, rates[k / CASES]);
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIDE, .height = SIDE, .turn_deg = 22
        };
        good = look_for_holes(g, &request, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* All numbers, by facets and by the reference; where facets are as many as there may be, that is said, and the second
   arithmetic, which takes the same ones, is not waited for. */
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
      .holds = "no ray passes between facets inside, at four rates",
      .unit = "pixels",
      .bound = { 0, 0 },
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
