#include "ui/patch/patch_cube.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/patch/patch.h"
#include "ui/patch/preview/rotation.h"

#include "scene/scene.h"
#include "surface/surface.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>

#define HALF_UNITS 21.0 /* half the side of the cube */
#define MARGIN_UNITS 12.0
#define TOP_UNITS 46.0 /* distance from the top, below the chips */
#define TURN_SECONDS 0.28
#define LEAST_UNITS 260.0 /* least size of a view with a cube */

/* Position and orientation of the cube; false: there is no room for it. */
typedef struct Cube {
    WrRotation stands;
    double x, y, half;
} Cube;

static WrRotation turntable(const WrApp *app)
{
    return wr_rotation_axis((WrVec3){ 0, 1, 0 }, app->patch->turn_deg);
}

/* Rotation from the world to the camera's axes. */
static WrRotation of_camera(const WrPlacement *at)
{
    const WrVec3 r = at->right, u = at->up, f = at->forward;
    return (WrRotation){ { r.x, r.y, r.z, u.x, u.y, u.z, -f.x, -f.y, -f.z } };
}

/* With a single object the cube shows the object's axes; with several, the world's. */
static bool several(const WrScene *scene)
{
    return scene->other_count > 0;
}

static WrRotation pose_of(const WrScene *scene)
{
    const double *pose = wr_surfaces[scene->shape.kind]->pose_deg;
    return wr_rotation_from_deg((WrVec3){ pose[0], pose[1], pose[2] });
}

static WrRotation own_of(const WrScene *scene)
{
    WrRotation pose = pose_of(scene), back = wr_rotation_inverse(&pose);
    WrRotation own = scene->posed ? wr_rotation_from_deg(scene->rotate_deg) : pose;
    return wr_rotation_times(&own, &back);
}

static bool find(const WrApp *app, Cube *cube)
{
    const SDL_Rect *r = &app->layout->patch;
    const WrScene *scene = wr_app_scene(app);
    double s = wr_gui_scale();
    WrPlacement at;
    if (r->w < LEAST_UNITS * s || r->h < LEAST_UNITS * s) return false;
    if (!wr_patch_place(app, &at)) return false;
    WrRotation camera = of_camera(&at), turn = turntable(app);
    cube->stands = wr_rotation_times(&camera, &turn);
    if (!several(scene)) {
        WrRotation own = own_of(scene);
        cube->stands = wr_rotation_times(&cube->stands, &own);
    }
    cube->half = HALF_UNITS * s;
    cube->x = r->x + r->w - (MARGIN_UNITS + 1.73 * HALF_UNITS) * s;
    cube->y = r->y + (TOP_UNITS + 1.73 * HALF_UNITS) * s;
    return true;
}

double wr_patch_cube_span(void)
{
    return 6.0 * HALF_UNITS * wr_gui_scale();
}

static bool side_at(const Cube *cube, double x, double y, int side[3])
{
    return wr_cube_at(&cube->stands, (x - cube->x) / cube->half, (cube->y - y) / cube->half, side);
}

bool wr_patch_cube_under(const WrApp *app, const WrPointer *at)
{
    Cube cube;
    int side[3];
    return find(app, &cube) && side_at(&cube, at->x, at->y, side);
}

/* ---- animated rotation ---- */

void wr_patch_cube_click(WrApp *app, const WrPointer *at)
{
    WrPatchCube *p = &app->patch->cube;
    Cube cube;
    int side[3];
    if (!find(app, &cube) || !side_at(&cube, at->x, at->y, side)) return;
    app->settings->turning = false;
    p->from = cube.stands;
    p->to = wr_cube_facing(side);
    p->began = wr_clock_seconds();
    wr_app_live_begin(app);
    wr_app_redraw(app);
}

/* Orbit the camera around the target to the given orientation of the cube. */
static void place_camera(WrApp *app, const WrRotation *stands)
{
    const WrRotation turn = turntable(app), back = wr_rotation_inverse(stands),
                     world = wr_rotation_times(&turn, &back);
    WrPlacement at;
    WrCamera *camera = &wr_app_live_begin(app)->camera;
    if (!wr_patch_place(app, &at)) return;
    const double away = v3_len(v3_sub(at.eye, camera->target));
    camera->eye = v3_mad(camera->target, wr_rotation_apply(&world, (WrVec3){ 0, 0, 1 }), away);
    camera->up = wr_rotation_apply(&world, (WrVec3){ 0, 1, 0 });
}

/* Rotate the object under the present camera. */
static void place_object(WrApp *app, const WrRotation *stands)
{
    WrPlacement at;
    if (!wr_patch_place(app, &at)) return;
    WrScene *scene = wr_app_live_begin(app);
    const WrRotation camera = of_camera(&at), turn = turntable(app), pose = pose_of(scene);
    const WrRotation seen = wr_rotation_times(&camera, &turn), back = wr_rotation_inverse(&seen);
    const WrRotation own = wr_rotation_times(&back, stands), whole = wr_rotation_times(&own, &pose);
    scene->posed = true;
    scene->rotate_deg = wr_rotation_to_deg(&whole);
}

void wr_patch_cube_update(WrApp *app, bool now)
{
    WrPatchCube *p = &app->patch->cube;
    if (p->began == 0.0) return;
    if (!app->live) { /* another action ended the live scene */
        p->began = 0.0;
        return;
    }
    double t = now ? 1.0 : (wr_clock_seconds() - p->began) / TURN_SECONDS;
    WrRotation stands = wr_rotation_between(&p->from, &p->to, wr_cube_ease(t));
    const bool camera = several(wr_app_scene(app));
    if (camera) place_camera(app, &stands);
    else place_object(app, &stands);
    if (t < 1.0) {
        wr_app_redraw(app);
        return;
    }
    p->began = 0.0;
    if (camera) wr_viewport_commit_camera(app);
    else wr_patch_commit_turn(app);
}

/* ---- drawing ---- */

static void spot(const Cube *cube, const double at[3], double *x, double *y)
{
    WrVec3 c = wr_rotation_apply(&cube->stands, (WrVec3){ at[0], at[1], at[2] });
    *x = cube->x + cube->half * c.x;
    *y = cube->y - cube->half * c.y;
}

/* Draw the part of the face of axis `k` at `end` between low and high along its other two axes. */
static void part(const Cube *cube, int k, double end, const double low[2], const double high[2],
                 WrColour colour)
{
    double x[4], y[4];
    for (int i = 0; i < 4; i++) {
        double at[3];
        at[k] = end;
        at[(k + 1) % 3] = i == 1 || i == 2 ? high[0] : low[0];
        at[(k + 2) % 3] = i >= 2 ? high[1] : low[1];
        spot(cube, at, &x[i], &y[i]);
    }
    wr_gui_draw_quad(x, y, colour);
}

static void ends_of(int side, double *low, double *high)
{
    *low = side < 0 ? -1 : side > 0 ? WR_CUBE_RIM : -WR_CUBE_RIM;
    *high = side > 0 ? 1 : side < 0 ? -WR_CUBE_RIM : WR_CUBE_RIM;
}

static void face(const Cube *cube, int k, int end, const int *hot)
{
    static const char *const names[3][2] = { { "Left", "Right" },
                                             { "Below", "Above" },
                                             { "Back", "Front" } };
    const double all[2] = { -1, -1 }, whole[2] = { 1, 1 };
    const double m = cube->stands.m[6 + k] * end; /* cosine towards the viewer */
    if (m < 0.02) return;
    part(cube, k, end, all, whole, hot ? WR_COLOUR_BUTTON_HOT : WR_COLOUR_BUTTON);
    if (hot && hot[k] == end) {
        double low[2], high[2];
        for (int i = 0; i < 2; i++) ends_of(hot[(k + 1 + i) % 3], &low[i], &high[i]);
        part(cube, k, end, low, high, WR_COLOUR_SELECTED);
    }
    double x[2], y[2], a[3];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 2; j++) {
            int corner = (i + j) % 4;
            a[k] = end;
            a[(k + 1) % 3] = corner == 1 || corner == 2 ? 1 : -1;
            a[(k + 2) % 3] = corner >= 2 ? 1 : -1;
            spot(cube, a, &x[j], &y[j]);
        }
        wr_gui_draw_line(x[0], y[0], x[1], y[1], WR_COLOUR_LABEL, wr_gui_scale());
    }
    const char *name = names[k][end > 0];
    const double wide = wr_gui_text_width(WR_FONT_SMALL, name);
    if (m < 0.6 || wide > 2.2 * cube->half * m) return;
    const double middle[3] = { k == 0 ? end : 0, k == 1 ? end : 0, k == 2 ? end : 0 };
    spot(cube, middle, &x[0], &y[0]);
    wr_gui_draw_text(rint(x[0] - wide / 2), rint(y[0] - wr_gui_line_height(WR_FONT_SMALL) / 2),
                     WR_FONT_SMALL, WR_COLOUR_TEXT, name);
}

void wr_patch_cube_draw(const WrApp *app)
{
    Cube cube;
    int side[3];
    const WrPointer *at = &app->hand->at;
    if (!find(app, &cube)) return;
    const bool over = app->hand->on_patch && app->hand->grab == WR_GRAB_NONE &&
                      side_at(&cube, at->x, at->y, side);
    for (int k = 0; k < 3; k++)
        for (int end = -1; end <= 1; end += 2) face(&cube, k, end, over ? side : NULL);
}
