#include "ui/patch/patch_projection.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/patch/patch.h"
#include "ui/patch/preview/rotation.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/text.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

#define LIVE_MOST 100000 /* triangles that are projected anew during a drag */

/* ---- the switch ---- */

bool wr_can_project(const WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    return scene->shape.kind == WR_SURFACE_mesh && scene->triangles &&
           scene->projection.kind != WR_PROJECTION_UV;
}

bool wr_is_projecting(const WrApp *app)
{
    return app->patch->projecting;
}

/* The view rests for it: a handle that turns away cannot be held. */
void wr_act_projection_handle(WrApp *app)
{
    app->patch->projecting = !app->patch->projecting;
    if (app->patch->projecting) app->settings->turning = false;
    wr_app_redraw(app);
}

bool wr_patch_projects(const WrApp *app)
{
    return app->patch->projecting && wr_can_project(app);
}

/* ---- the projection ---- */

WrVec3 wr_projection_origin(const WrScene *scene)
{
    const WrProjection *is = &scene->projection;
    const double *at = is->placed ? is->at : scene->triangles->centre;
    return (WrVec3){ at[0], at[1], at[2] };
}

/* Size of the mesh, to the projection's origin. */
double wr_projection_least_cell(const WrScene *scene, const WrProjection *is)
{
    const WrTriangles *mesh = scene->triangles;
    double away = 2 * mesh->radius;
    for (int k = 0; k < 3 && is->placed; k++) away += fabs(is->at[k] - mesh->centre[k]);
    return 8 * away * wr_length_unit_mm(is->unit) / WR_PROJECTION_CELLS;
}

void wr_projection_live(WrApp *app, const WrProjection *is)
{
    WrScene *live = wr_app_live_begin(app);
    const WrTriangles *from = wr_scene_mesh_source(live);
    const bool small = from && from->triangle_count <= LIVE_MOST;
    if (!small || !wr_scene_project(live, is, NULL)) live->projection = *is;
}

/* ---- a drag ---- */

static WrRotation rotation_of(const WrPlacement *place)
{
    WrRotation r;
    memcpy(r.m, place->rotation, sizeof r.m);
    return r;
}

static WrRotation turn_of(const WrProjection *is)
{
    return wr_rotation_from_deg((WrVec3){ is->turn_deg[0], is->turn_deg[1], is->turn_deg[2] });
}

/* Digits after the point for places on the mesh: a ten-thousandth of its size. */
static int digits_for(const WrTriangles *mesh)
{
    const double digits = 4 - floor(log10(mesh->radius));
    return (int)fmin(9, fmax(0, digits));
}

static void move(const WrApp *app, const WrPatchBall *ball, double dx, double dy, WrProjection *is)
{
    const WrVec3 by =
        v3_mad(v3_scale(ball->at.right, dx * ball->pixel), ball->at.up, -dy * ball->pixel);
    const WrVec3 from = wr_object_to_world(&ball->at, app->patch->from_at);
    const WrVec3 to = wr_line_round_vec(wr_world_to_object(&ball->at, v3_add(from, by)),
                                        digits_for(wr_app_scene(app)->triangles));
    is->placed = true;
    is->at[0] = to.x, is->at[1] = to.y, is->at[2] = to.z;
}

/* The cell is proportional to the pointer's distance from the centre, so the handle stays under the pointer. */
static void scale(const WrApp *app, const WrPatchBall *ball, const WrPointer *at, WrProjection *is)
{
    const WrPointer *start = &app->hand->start;
    const double before = hypot(start->x - ball->x, start->y - ball->y);
    const double by = hypot(at->x - ball->x, at->y - ball->y) / fmax(before, 1);
    const double least = wr_projection_least_cell(wr_app_scene(app), is);
    for (int k = 0; k < 2; k++)
        is->cell[k] = fmax(least, fmin(1e9, wr_line_round(is->cell[k] * by, 3)));
}

/* As a trackball about the view's axes: the projection's rotation in the world is the object's times its own. */
static void turn(const WrPatchBall *ball, double dx, double dy, WrProjection *is)
{
    const WrRotation object = rotation_of(&ball->at), own = turn_of(is);
    const WrRotation before = wr_rotation_times(&object, &own);
    const WrRotation now =
        wr_rotation_dragged(&before, 0, ball->at.right, ball->at.up, dx, dy, 4 * ball->radius);
    const WrRotation back = wr_rotation_inverse(&object), to = wr_rotation_times(&back, &now);
    const WrVec3 deg = wr_line_round_vec(wr_rotation_to_deg(&to), 2);
    is->turn_deg[0] = deg.x, is->turn_deg[1] = deg.y, is->turn_deg[2] = deg.z;
}

void wr_patch_projection_drag(WrApp *app, const WrPatchBall *ball, const WrPointer *at)
{
    const double dx = at->x - app->hand->start.x, dy = at->y - app->hand->start.y;
    WrProjection is = app->patch->from_projection;
    if (app->patch->handle == WR_HANDLE_MOVE) move(app, ball, dx, dy, &is);
    else if (app->patch->handle == WR_HANDLE_SIZE) scale(app, ball, at, &is);
    else turn(ball, dx, dy, &is);
    wr_projection_live(app, &is);
}

void wr_patch_projection_line(const WrApp *app, WrText *line)
{
    const WrProjection *is = &app->live->projection;
    wr_text_add(line, "surface mesh");
    if (app->patch->handle == WR_HANDLE_MOVE)
        wr_line_vec(line, "at", (WrVec3){ is->at[0], is->at[1], is->at[2] });
    else if (app->patch->handle == WR_HANDLE_TURN)
        wr_line_vec(line, "turn", (WrVec3){ is->turn_deg[0], is->turn_deg[1], is->turn_deg[2] });
    else {
        wr_line_number(line, "cell", is->cell[0]);
        wr_text_add(line, ",");
        wr_text_add_number(line, is->cell[1]);
    }
}

/* ---- drawing ---- */

/* Axes that point away from the eye are dim. */
static void draw_axes(const WrPatchBall *ball, const WrRotation *world)
{
    static const char *const names[3] = { "x", "y", "z" };
    static const WrColour colours[3] = { 0xf06050, 0x70c860, 0x60a0f8 };
    const double s = wr_gui_scale(), length = 1.15 * ball->radius;
    for (int k = 0; k < 3; k++) {
        const WrVec3 v = wr_rotation_apply(world, (WrVec3){ k == 0, k == 1, k == 2 });
        const WrColour alpha = v3_dot(v, ball->at.forward) > 0 ? 0x70000000u : 0xf0000000u;
        const double x = ball->x + length * v3_dot(v, ball->at.right);
        const double y = ball->y - length * v3_dot(v, ball->at.up);
        wr_gui_draw_line(ball->x, ball->y, x, y, alpha & 0x80000000u, 4 * s);
        wr_gui_draw_line(ball->x, ball->y, x, y, alpha | colours[k], 2 * s);
        wr_gui_draw_text(x + 4 * s, y - 8 * s, WR_FONT_SMALL, alpha | colours[k], names[k]);
    }
}

/* One cell of the table about the origin, as the projection along z lays it. */
static void draw_cell(const WrPatchBall *ball, const WrRotation *world, const WrProjection *is)
{
    const double s = wr_gui_scale(),
                 pixels = ball->at.size / wr_length_unit_mm(is->unit) / ball->pixel;
    double x[4], y[4];
    if (is->kind != WR_PROJECTION_PLANAR && is->kind != WR_PROJECTION_BOX) return;
    for (int k = 0; k < 4; k++) {
        const WrVec3 corner = { (k == 1 || k == 2) * is->cell[0], (k >= 2) * is->cell[1], 0 };
        const WrVec3 v = wr_rotation_apply(world, v3_scale(corner, pixels));
        x[k] = ball->x + v3_dot(v, ball->at.right);
        y[k] = ball->y - v3_dot(v, ball->at.up);
    }
    for (int k = 0; k < 4; k++) {
        const int next = (k + 1) % 4;
        wr_gui_draw_line(x[k], y[k], x[next], y[next], 0x80000000u, 3 * s);
        wr_gui_draw_line(x[k], y[k], x[next], y[next], 0xe0f0f0f0u, 1.3 * s);
    }
}

void wr_patch_projection_draw(const WrApp *app, const WrPatchBall *ball)
{
    const WrProjection *is = &wr_app_scene(app)->projection;
    const WrRotation object = rotation_of(&ball->at), own = turn_of(is);
    const WrRotation world = wr_rotation_times(&object, &own);
    draw_cell(ball, &world, is);
    draw_axes(ball, &world);
}
