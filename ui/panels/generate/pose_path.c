#include "ui/panels/generate/pose_path.h"

#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/session_view.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/canvas/view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "field/field.h"
#include "generate/generator.h"
#include "generate/svg_path.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define NEAR_UNITS 9.0
#define POINTS_MAX 500 /* handles that are shown */

/* The data on the table: texel = place + scale * turn(point - middle of the box), y down. */
typedef struct Laid {
    WrSvgPath path;
    int param, place, size;
    double scale, cosine, sine, middle[2], at[2];
} Laid;

int wr_pose_path_param(const WrGenerateState *hand)
{
    for (int i = 0; hand->generator && hand->generator->params[i].name; i++)
        if (hand->generator->params[i].path) return i;
    return -1;
}

static void box_of(const WrSvgPath *path, double box[4])
{
    WrSvgOutline outline;
    wr_svg_path_outline(path, &outline);
    wr_svg_outline_box(&outline, box);
    wr_svg_outline_fini(&outline);
}

/* False: no such parameter, or malformed data. */
static bool lay(const WrApp *app, Laid *out)
{
    const WrGenerateState *hand = app->generate;
    double box[4];
    *out = (Laid){ .param = wr_pose_path_param(hand) };
    if (out->param < 0 || !wr_svg_path_parse(hand->value[out->param].text, &out->path))
        return false;
    const WrGenerator *g = hand->generator;
    out->place = wr_generator_param_find(g, "at");
    out->size = wr_generator_param_find(g, "size");
    const double turn =
        hand->value[wr_generator_param_find(g, "rotate")].number[0] * WR_RAD_PER_DEG;
    box_of(&out->path, box);
    out->scale = hand->value[out->size].number[0] / fmax(box[2], box[3]);
    out->cosine = cos(turn);
    out->sine = sin(turn);
    for (int k = 0; k < 2; k++) out->middle[k] = box[k] + 0.5 * box[2 + k];
    const double *at = hand->value[out->place].number;
    out->at[0] = at[0] * app->view->table_w;
    out->at[1] = (1.0 - at[1]) * app->view->table_h;
    if (isfinite(out->scale) && out->scale > 0.0) return true;
    wr_svg_path_fini(&out->path);
    return false;
}

static void to_texel(const Laid *laid, double x, double y, double out[2])
{
    const double dx = laid->scale * (x - laid->middle[0]), dy = laid->scale * (y - laid->middle[1]);
    out[0] = laid->at[0] + laid->cosine * dx + laid->sine * dy;
    out[1] = laid->at[1] + laid->cosine * dy - laid->sine * dx;
}

static void from_texel(const Laid *laid, double x, double y, double out[2])
{
    const double dx = (x - laid->at[0]) / laid->scale, dy = (y - laid->at[1]) / laid->scale;
    out[0] = laid->middle[0] + laid->cosine * dx - laid->sine * dy;
    out[1] = laid->middle[1] + laid->cosine * dy + laid->sine * dx;
}

/* The texel under the pointer, on the copy of the cell that is nearest to the drawing's middle. */
static void pointed(const WrApp *app, const Laid *laid, const WrPointer *at, double out[2])
{
    const WrField *field = wr_app_field(app);
    const double w = app->view->table_w, h = app->view->table_h;
    wr_view_to_texel(app->view, at->x, at->y, &out[0], &out[1]);
    if (wr_field_wrap_u(field) == WR_WRAP_PERIODIC) out[0] -= w * rint((out[0] - laid->at[0]) / w);
    if (wr_field_wrap_v(field) == WR_WRAP_PERIODIC) out[1] -= h * rint((out[1] - laid->at[1]) / h);
}

/* The point under the pointer, ends before handles; -1: none. */
static int find(const WrApp *app, const Laid *laid, const WrPointer *at)
{
    WrSvgPoint points[POINTS_MAX];
    const int all = wr_svg_path_points(&laid->path, points, POINTS_MAX);
    const int count = all < POINTS_MAX ? all : POINTS_MAX;
    const double near = NEAR_UNITS * wr_gui_scale() / app->view->zoom;
    double here[2], texel[2];
    pointed(app, laid, at, here);
    for (int pass = 0; pass < 2; pass++)
        for (int i = count - 1; i >= 0; i--) {
            to_texel(laid, points[i].x, points[i].y, texel);
            if (points[i].handle == (pass == 1) &&
                hypot(texel[0] - here[0], texel[1] - here[1]) < near)
                return i;
        }
    return -1;
}

static bool point_of(const Laid *laid, int index, WrSvgPoint *out)
{
    WrSvgPoint points[POINTS_MAX];
    const int count = wr_svg_path_points(&laid->path, points, POINTS_MAX);
    if (index < 0 || index >= count || index >= POINTS_MAX) return false;
    *out = points[index];
    return true;
}

/* Digits for a thousandth of a texel. */
static int digits_of(const Laid *laid)
{
    const double digits = ceil(log10(1000.0 * laid->scale));
    return digits < 0.0 ? 0 : digits > 9.0 ? 9 : (int)digits;
}

/* Store the changed data; size and place are those of its box, so that its other points stay where they are. */
static void store(WrApp *app, const Laid *laid)
{
    WrGenerateState *hand = app->generate;
    WrText text = { 0 };
    WrSvgPath path;
    double box[4], texel[2];
    wr_svg_path_print(&laid->path, digits_of(laid), &text);
    const bool fits = text.length < WR_GENERATE_TEXT && wr_svg_path_parse(text.data, &path);
    if (fits) {
        box_of(&path, box);
        const double size = laid->scale * fmax(box[2], box[3]);
        to_texel(laid, box[0] + 0.5 * box[2], box[1] + 0.5 * box[3], texel);
        if (size > 0.01) {
            wr_generate_set_text(&hand->value[laid->param], text.data);
            hand->value[laid->size].number[0] = wr_line_round(size, 4);
            double *at = hand->value[laid->place].number;
            at[0] = wr_line_round(texel[0] / app->view->table_w, 7);
            at[1] = wr_line_round(1.0 - texel[1] / app->view->table_h, 7);
            hand->preset = -2;
            wr_generate_changed(app);
        }
        wr_svg_path_fini(&path);
    }
    wr_text_fini(&text);
}

bool wr_pose_path_press(WrApp *app, const WrPointer *at)
{
    WrGenerateState *hand = app->generate;
    Laid laid;
    WrSvgPoint point;
    if (!lay(app, &laid)) return false;
    hand->point = find(app, &laid, at);
    bool took = hand->point >= 0;
    if (took && (at->mods & WR_MOD_CTRL)) {
        if (point_of(&laid, hand->point, &point) && wr_svg_path_remove(&laid.path, &point))
            store(app, &laid);
        hand->point = -1;
    } else if (at->mods & WR_MOD_CTRL) {
        double here[2], place[2];
        pointed(app, &laid, at, here);
        from_texel(&laid, here[0], here[1], place);
        took = wr_svg_path_divide(&laid.path, place[0], place[1]);
        if (took) store(app, &laid);
        wr_svg_path_fini(&laid.path);
        if (took && lay(app, &laid)) hand->point = find(app, &laid, at);
        else return took;
    }
    wr_svg_path_fini(&laid.path);
    return took;
}

void wr_pose_path_drag(WrApp *app, const WrPointer *at)
{
    Laid laid;
    WrSvgPoint point;
    if (!lay(app, &laid)) return;
    if (point_of(&laid, app->generate->point, &point)) {
        double here[2], place[2];
        pointed(app, &laid, at, here);
        from_texel(&laid, here[0], here[1], place);
        wr_svg_path_move(&laid.path, &point, place[0], place[1]);
        store(app, &laid);
    }
    wr_svg_path_fini(&laid.path);
}

bool wr_pose_path_remove(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    Laid laid;
    WrSvgPoint point;
    if (hand->point < 0 || !lay(app, &laid)) return false;
    const bool found = point_of(&laid, hand->point, &point);
    if (found && wr_svg_path_remove(&laid.path, &point)) store(app, &laid);
    hand->point = -1;
    wr_svg_path_fini(&laid.path);
    return found;
}

/* ---- drawing ---- */

static WrSelectPoint uv_of(const WrApp *app, const Laid *laid, double x, double y)
{
    double texel[2];
    to_texel(laid, x, y, texel);
    return wr_overlay_uv(app, texel[0], texel[1]);
}

static void draw_outline(const WrApp *app, const Laid *laid)
{
    WrSvgOutline outline;
    WR_ARRAY(WrSelectPoint) line = { 0 };
    wr_svg_path_outline(&laid->path, &outline);
    for (int i = 0; i < outline.first.count; i++) {
        const int to =
            i + 1 < outline.first.count ? outline.first.data[i + 1] : outline.xy.count / 2;
        line.count = 0;
        for (int k = outline.first.data[i]; k < to; k++)
            wr_array_push(&line,
                          uv_of(app, laid, outline.xy.data[2 * k], outline.xy.data[2 * k + 1]));
        if (line.count > 1) wr_overlay_lines(app, line.data, line.count, true, 0xb0d0d0d0u);
    }
    wr_array_free(&line);
    wr_svg_outline_fini(&outline);
}

void wr_pose_path_marks(const WrApp *app)
{
    WrSvgPoint points[POINTS_MAX];
    Laid laid;
    if (!lay(app, &laid)) return;
    const int all = wr_svg_path_points(&laid.path, points, POINTS_MAX);
    draw_outline(app, &laid);
    for (int i = 0; i < all && i < POINTS_MAX; i++) {
        const WrSvgPoint *p = &points[i];
        const WrSelectPoint uv = uv_of(app, &laid, p->x, p->y);
        const WrSelectPoint arm[2] = { uv, uv_of(app, &laid, p->of[0], p->of[1]) };
        if (p->handle) wr_overlay_lines(app, arm, 2, false, WR_COLOUR_ACCENT);
        wr_overlay_handle(app, uv.u, uv.v, p->handle, i == app->generate->point);
    }
    wr_svg_path_fini(&laid.path);
}
