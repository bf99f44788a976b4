/* Stamp tool: a picture, or the round brush, applied once. A preview under the pointer is shown on canvas and patch,
   computed on a snapshot. Press to set the centre, drag for rotation and size, release to apply. The wheel changes
   the size, Enter applies at the pointer, Escape cancels. */
#include "ui/canvas/tools/tool_stamp.h"
#include "ui/app/state/app_state.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/canvas/tools/brush_command_text.h"
#include "ui/canvas/tools/option_row.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/tool_rows.h"
#include "ui/canvas/overlays/marks.h"
#include "ui/app/jobs/edit_preview.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/app/state/action.h"
#include "ui/toolkit/theme.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/thumbs.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/brush.h"
#include "brush/library.h"
#include "brush/symmetry.h"
#include "brush/tip.h"
#include "field/select.h"
#include "system/path.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- pictures: those in the brush folders that are not thumbnails of presets ---- */

#define DEPTH_MAX 3     /* depth of nested folders */
#define STAMPS_MAX 2000 /* limit for all folders */

static void stamp_picker(WrApp *app);

static bool has_ending(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n > m && SDL_strcasecmp(name + n - m, ending) == 0;
}

static bool is_picture(const char *name)
{
    static const char *const endings[] = {
        ".png", ".gbr", ".gih", ".jpg", ".tif", ".tiff", ".exr"
    };
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (has_ending(name, endings[i])) return true;
    return false;
}

/* NAME.png beside NAME.myb, or NAME_prev.png, is the thumbnail of a preset. */
static bool is_thumbnail(const char *folder, const char *name)
{
    const char *dot = strrchr(name, '.');
    size_t length = (size_t)(dot - name);
    if (length > 5 && strncmp(dot - 5, "_prev", 5) == 0) return true;
    WrText preset = { 0 };
    wr_text_addf(&preset, "%s/%.*s.myb", folder, (int)length, name);
    bool there = wr_path_is_there(wr_text_get(&preset));
    wr_text_fini(&preset);
    return there;
}

static void add_stamp(WrApp *app, const char *path, const char *group, const char *words)
{
    wr_array_push(&app->stamp->stamps,
                  ((WrStamp){ wr_strdup(path), wr_strdup(group), wr_strdup(words) }));
}

static int by_name(const void *a, const void *b)
{
    char *const *x = a, *const *y = b;
    return SDL_strcasecmp(*x, *y);
}

typedef WR_ARRAY(char *) Names; /* owned */

static Names list_folder(const char *path)
{
    Names names = { 0 };
    WrFolder *folder = wr_folder_open(path);
    for (const char *name; folder && (name = wr_folder_next(folder));)
        if (name[0] != '.') wr_array_push(&names, wr_strdup(name));
    wr_folder_close(folder);
    if (names.count > 1) qsort(names.data, (size_t)names.count, sizeof *names.data, by_name);
    return names;
}

static void search(WrApp *app, const char *folder, const char *group, int depth)
{
    Names names = list_folder(folder);
    for (int i = 0; i < names.count; i++) {
        const char *name = names.data[i];
        char *path = wr_path_join(folder, name);
        bool folder_too = wr_path_is_folder(path);
        if (folder_too && depth < DEPTH_MAX) search(app, path, group, depth + 1);
        bool takes = !folder_too && is_picture(name) && !is_thumbnail(folder, name) &&
                     app->stamp->stamps.count < STAMPS_MAX;
        if (takes) add_stamp(app, path, group, "");
        wr_free(path);
        wr_free(names.data[i]);
    }
    wr_array_free(&names);
}

/* Groups of stamps and words for their search: lines "Group: NAME" and "STAMP: WORDS". */
static void search_shipped(WrApp *app)
{
    WrText place = { 0 };
    char *text = NULL, *group = NULL;
    size_t length;
    bool there = wr_data_find("brushes/stamps/stamps.conf", &place) &&
                 wr_file_read(wr_text_get(&place), 1u << 20, &text, &length, NULL);
    for (char *line = there ? text : NULL; line && *line;) {
        char *end = line + strcspn(line, "\n"), *next = end + (*end != '\0');
        *end = '\0';
        char *words = line[0] != '#' ? strchr(line, ':') : NULL;
        if (words) {
            *words++ = '\0';
            words += *words == ' ';
            WrText file = { 0 };
            wr_text_addf(&file, "%.*s/%s.png", (int)(place.length - strlen("/stamps.conf")),
                         wr_text_get(&place), line);
            if (strcmp(line, "Group") == 0) group = words;
            else add_stamp(app, wr_text_get(&file), group ? group : "", words);
            wr_text_fini(&file);
        }
        line = next;
    }
    wr_free(text);
    wr_text_fini(&place);
}

/* Brushes that other programs install. */
static void search_programs(WrApp *app)
{
    static const struct {
        const char *folder, *group;
    } programs[] = { { "gimp/2.0/brushes", "GIMP" },
                     { "gimp/3.0/brushes", "GIMP" },
                     { "krita/brushes", "Krita" } };
    WrText path = { 0 };
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        if (wr_shared_find(programs[i].folder, &path))
            search(app, wr_text_get(&path), programs[i].group, 0);
    wr_text_fini(&path);
}

void wr_stamps_find(WrApp *app)
{
    WrText ours = { 0 };
    WrError err;
    if (app->stamp->stamps_known) return;
    app->stamp->stamps_known = true;
    char *user = wr_library_user_folder(&err);
    if (user) search(app, user, "My own", 0);
    wr_free(user);
    search_shipped(app);
    if (wr_data_find("brushes", &ours)) /* without its folders */
        search(app, wr_text_get(&ours), "Tips of brushes", DEPTH_MAX);
    wr_text_fini(&ours);
    search_programs(app);
}

static void stamps_free(WrApp *app)
{
    for (int i = 0; i < app->stamp->stamps.count; i++) {
        wr_free(app->stamp->stamps.data[i].path);
        wr_free(app->stamp->stamps.data[i].group);
        wr_free(app->stamp->stamps.data[i].words);
    }
    wr_array_free(&app->stamp->stamps);
    app->stamp->stamps_known = false;
}

/* A hash of the names of the pictures and presets in the user's folder. */
static uint64_t names_hash(const char *path, int depth)
{
    Names names = list_folder(path);
    uint64_t hash = 0xcbf29ce484222325u + (uint64_t)names.count;
    for (int i = 0; i < names.count; i++) {
        char *inner = wr_path_join(path, names.data[i]);
        for (const char *c = names.data[i]; *c; c++)
            hash = (hash ^ (unsigned char)*c) * 0x100000001b3u;
        if (depth < DEPTH_MAX && wr_path_is_folder(inner)) hash ^= names_hash(inner, depth + 1);
        wr_free(inner);
        wr_free(names.data[i]);
    }
    wr_array_free(&names);
    return hash;
}

bool wr_stamps_changed(WrApp *app)
{
    WrError err;
    char *user = wr_library_user_folder(&err);
    uint64_t now = user ? names_hash(user, 0) : 0;
    bool changed = app->stamp->folder != 0 && app->stamp->folder != now;
    app->stamp->folder = now;
    wr_free(user);
    if (changed) stamps_free(app);
    return changed;
}

/* ---- the stamp ---- */

#define DRAG_PIXELS 8.0
#define FIRST_RADIUS 48.0

static double radius_of(const WrApp *app)
{
    double least = fmin(app->view->table_w, app->view->table_h);
    return app->stamp->radius > 0.0 ? app->stamp->radius
                                    : fmax(1.0, fmin(FIRST_RADIUS, least / 6.0));
}

static WrBrush brush_of(const WrApp *app)
{
    WrBrush brush = wr_brush_now(app);
    brush.preset = NULL;
    brush.tip = app->stamp->tip;
    brush.radius = radius_of(app);
    brush.angle_deg = app->stamp->angle_deg;
    brush.aspect = 1.0;
    brush.follow = false;
    brush.jitter_place = brush.jitter_angle_deg = brush.jitter_size = 0.0;
    brush.flow = 1.0;
    brush.seed = 0;
    return brush;
}

/* Use that picture, NULL: the round brush. False: unreadable, with a message. */
static bool use_picture(WrApp *app, const char *path)
{
    WrStampState *draw = app->stamp;
    WrError err;
    WrTip *tip = path ? wr_tip_read(path, &err) : NULL;
    if (path && !tip) {
        wr_app_fail(app, &err);
        return false;
    }
    char *copy = path ? wr_strdup(path) : NULL;
    wr_tip_free(draw->tip);
    wr_free(draw->tip_path);
    draw->tip = tip;
    draw->tip_path = copy;
    draw->trying = false;
    wr_app_redraw(app);
    return true;
}

void wr_stamp_forget(WrApp *app)
{
    wr_tip_free(app->stamp->tip);
    wr_free(app->stamp->tip_path);
    stamps_free(app);
    app->stamp->tip = NULL;
    app->stamp->tip_path = NULL;
}

/* ---- preview ---- */

/* The centre, rounded as in the command. */
static void place_of(const WrApp *app, double *u, double *v)
{
    const WrStampState *draw = app->stamp;
    double pu = draw->placed ? draw->u : app->hand->at.u,
           pv = draw->placed ? draw->v : app->hand->at.v;
    WrSelectPoint home = wr_overlay_wrap_offset(app, pu, pv);
    *u = wr_line_round(pu + home.u, 7);
    *v = wr_line_round(pv + home.v, 7);
}

static bool is_wanted(const WrApp *app)
{
    bool free = app->hand->grab == WR_GRAB_NONE || app->hand->grab == WR_GRAB_TOOL;
    return wr_tool_now(app) == &wr_tool_stamp && app->dialog->now == WR_DIALOG_NONE && free &&
           (app->stamp->placed || (app->hand->on_canvas && !app->hand->space));
}

/* Compare all brush values that a stamp uses. */
static bool same_brush(const WrBrush *a, const WrBrush *b)
{
    const WrSymmetry *s = &a->symmetry, *t = &b->symmetry;
    return a->tip == b->tip && a->radius == b->radius && a->hardness == b->hardness &&
           a->angle_deg == b->angle_deg && a->strength == b->strength && a->mode == b->mode &&
           a->to == b->to && a->opacity == b->opacity && a->reach == b->reach &&
           s->mirror_u == t->mirror_u && s->mirror_v == t->mirror_v && s->radial == t->radial &&
           s->centre_u == t->centre_u && s->centre_v == t->centre_v && s->repeat_u == t->repeat_u &&
           s->repeat_v == t->repeat_v && s->stagger == t->stagger;
}

static void update(WrApp *app)
{
    WrStampState *draw = app->stamp;
    if (!is_wanted(app)) {
        if (draw->trying && app->dialog->now == WR_DIALOG_NONE) wr_app_try_end(app);
        draw->trying = false;
        return;
    }
    WrBrush brush = brush_of(app);
    WrEditPreviewRequest ask = { .dab = &brush };
    place_of(app, &ask.u, &ask.v);
    bool same = draw->trying && app->trying && draw->tried.u == ask.u && draw->tried.v == ask.v &&
                same_brush(&draw->tried_brush, &brush);
    if (same || wr_edit_preview_busy(app->trial, NULL, NULL)) return;
    draw->tried = ask;
    draw->tried_brush = brush;
    draw->trying = true;
    wr_app_try(app, &ask);
}

static void leave(WrApp *app)
{
    app->stamp->placed = app->stamp->dragged = false;
    if (app->stamp->trying) wr_app_try_end(app);
    app->stamp->trying = false;
}

/* ---- commands ---- */

static void add_brush(const WrApp *app, WrBrush brush, WrText *line)
{
    const WrBrush base = wr_brush_default();
    const WrBrushNames names = { .tip = app->stamp->tip_path };
    brush.radius = wr_line_round(brush.radius, 3);
    brush.angle_deg = wr_line_round(brush.angle_deg, 3);
    wr_brush_line(line, &brush, &base, &names);
}

static void commit(WrApp *app)
{
    WrStampState *draw = app->stamp;
    WrText line = { 0 };
    double u, v;
    place_of(app, &u, &v);
    wr_text_add(&line, "dab ");
    wr_text_add_number(&line, u);
    wr_text_add(&line, ",");
    wr_text_add_number(&line, v);
    add_brush(app, brush_of(app), &line);
    app->hand->grab = WR_GRAB_NONE;
    draw->placed = draw->dragged = draw->trying = false;
    app->hints = false;
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- on the patch ---- */

bool wr_stamp_is_chosen(const WrApp *app)
{
    return wr_tool_now(app) == &wr_tool_stamp;
}

WrBrushMark wr_stamp_mark(const WrApp *app)
{
    return (WrBrushMark){ .radius = radius_of(app),
                          .aspect = 1,
                          .turn = app->stamp->angle_deg * WR_RAD_PER_DEG,
                          .square = app->stamp->tip != NULL };
}

void wr_stamp_at(WrApp *app, double u, double v)
{
    app->stamp->placed = true;
    app->stamp->u = u;
    app->stamp->v = v;
    commit(app);
}

void wr_stamp_on_mesh(WrApp *app, WrVec3 p, const WrVec3 *eye, double turn_deg)
{
    WrBrush brush = brush_of(app);
    WrText line = { 0 };
    brush.symmetry = wr_brush_default().symmetry; /* of the table */
    brush.angle_deg = remainder(brush.angle_deg + turn_deg, 360.0);
    wr_text_add(&line, "sculpt");
    wr_line_vec(&line, "points", p);
    wr_strokes_mesh_line(app, eye, &line);
    add_brush(app, brush, &line);
    app->hints = false;
    wr_app_run_line(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- dragging ---- */

static void press(WrApp *app, const WrPointer *at)
{
    WrStampState *draw = app->stamp;
    draw->placed = true;
    draw->dragged = false;
    draw->u = at->u;
    draw->v = at->v;
    draw->first_radius = draw->radius;
    draw->first_angle = draw->angle_deg;
    wr_app_redraw(app);
}

static void drag(WrApp *app, const WrPointer *at)
{
    WrStampState *draw = app->stamp;
    double dx = at->x - app->hand->start.x, dy = at->y - app->hand->start.y, way = hypot(dx, dy);
    if (!draw->placed || (!draw->dragged && way < DRAG_PIXELS * wr_gui_scale())) return;
    draw->dragged = true;
    double to_x, to_y;
    wr_view_step_back(app->view, dx, dy, &to_x, &to_y);
    double turn = atan2(-to_y, to_x) * WR_DEG_PER_RAD;
    if (at->mods & WR_MOD_SHIFT) turn = rint(turn / 15.0) * 15.0;
    draw->angle_deg = wr_line_round(turn, 1);
    draw->radius = wr_line_round(fmax(way / app->view->zoom, 0.5), 1);
    wr_app_redraw(app);
}

static void release(WrApp *app, const WrPointer *at)
{
    (void)at;
    if (app->stamp->placed) commit(app);
}

static bool key(WrApp *app, SDL_Keycode key)
{
    WrStampState *draw = app->stamp;
    if (key == SDLK_ESCAPE && draw->placed) {
        draw->radius = draw->first_radius;
        draw->angle_deg = draw->first_angle;
        app->hand->grab = WR_GRAB_NONE;
        leave(app);
        wr_app_redraw(app);
        return true;
    }
    if ((key != SDLK_RETURN && key != SDLK_KP_ENTER) || !(app->hand->on_canvas || draw->placed))
        return false;
    commit(app);
    return true;
}

static bool wheel(WrApp *app, double steps)
{
    if (app->hand->mods != 0) return false; /* Ctrl+wheel still zooms */
    double r = radius_of(app) * exp2(steps / 6.0);
    r = r < 0.5 ? 0.5 : r > 16384.0 ? 16384.0 : r;
    app->stamp->radius = wr_line_round(r, r < 10.0 ? 1 : 0);
    wr_app_redraw(app);
    return true;
}

/* ---- drawing on the canvas ---- */

/* Its frame: the picture's rotated edges; a circle for the round brush. */
static void overlay(WrApp *app)
{
    WrSelectPoint points[48];
    double u, v, r = radius_of(app), a = app->stamp->angle_deg * WR_RAD_PER_DEG;
    int count = app->stamp->tip ? 4 : 48, w = 1, h = 1;
    if (app->stamp->tip) wr_tip_size(app->stamp->tip, 0, &w, &h);
    double longer = w > h ? w : h;
    place_of(app, &u, &v);
    double x = u * app->view->table_w, y = (1.0 - v) * app->view->table_h;
    for (int i = 0; i < count; i++) {
        double turn = 6.283185307179586 * i / count;
        double px = count == 4 ? (i == 0 || i == 3 ? r : -r) * w / longer : r * cos(turn);
        double py = count == 4 ? (i < 2 ? r : -r) * h / longer : r * sin(turn); /* up */
        points[i] =
            wr_overlay_uv(app, x + px * cos(a) - py * sin(a), y - px * sin(a) - py * cos(a));
    }
    wr_overlay_lines(app, points, count, true, 0xd0f4f4f4u);
}

static void marks(WrApp *app)
{
    const WrStampState *draw = app->stamp;
    char text[64];
    if (!draw->placed || !draw->dragged) return;
    wr_words_print(text, sizeof text, "%.4g px  %.0f\xc2\xb0", 2.0 * draw->radius, draw->angle_deg);
    wr_overlay_label(app->hand->start.x, app->hand->start.y, text);
}

/* ---- options ---- */

static void stamp_size(WrApp *app, double width)
{
    static const WrNumber spec = { .low = 4,
                                   .high = 1000,
                                   .hard_low = 1,
                                   .hard_high = 32768,
                                   .reset = 96,
                                   .decimals = -1,
                                   .unit = "px",
                                   .logarithmic = true,
                                   .tip = "Length of the picture's longer side, in texels" };
    double diameter = 2.0 * (app->stamp->radius > 0.0 ? app->stamp->radius : 48.0);
    if (wr_gui_number("stamp_size", width, &spec, &diameter)) app->stamp->radius = diameter / 2.0;
}

static void stamp_angle(WrApp *app, double width)
{
    static const WrNumber spec = { .low = -180,
                                   .high = 180,
                                   .hard_low = -360,
                                   .hard_high = 360,
                                   .reset = 0,
                                   .decimals = 0,
                                   .unit = "\xc2\xb0",
                                   .tip = "Turns the picture anticlockwise" };
    wr_gui_number("stamp_angle", width, &spec, &app->stamp->angle_deg);
}

static void options(WrApp *app)
{
    unsigned uses = wr_current_brush_mode(app)->uses;
    const WrOption items[] = { { "##Stamp mode", 104, 12, wr_option_mode, true },
                               { "Size", 92, 0, stamp_size, true },
                               { "Angle", 74, 0, stamp_angle, true },
                               { "Strength", 84, 0, wr_option_strength,
                                 (uses & WR_USES_STRENGTH) != 0 },
                               { "Height", 84, 0, wr_option_to_height, (uses & WR_USES_TO) != 0 },
                               { "##Symmetry", 28, 0, wr_option_symmetry, true },
                               { "Hardness", 74, 0, wr_option_hardness, app->stamp->tip == NULL },
                               { "Opacity", 84, 0, wr_option_opacity, true } };
    stamp_picker(app);
    wr_option_row(app, items, (int)(sizeof items / sizeof *items));
}

/* ---- the row ---- */

const WrTool wr_tool_stamp = { .action = WR_ACT(stamp),
                               .icon = WR_ICON_STAMP,
                               .help = "Press at the position of the stamp, drag to set angle and "
                                       "size, and release; the wheel sizes it.",
                               .press = press,
                               .drag = drag,
                               .release = release,
                               .overlay = overlay,
                               .marks = marks,
                               .options = options,
                               .key = key,
                               .wheel = wheel,
                               .leave = leave,
                               .meanwhile = true };

void wr_stamp_file_chosen(WrApp *app, const char *path)
{
    use_picture(app, path);
}

const WrPart wr_part_stamp = { .update = update };

/* ---- choice of the stamp tool's picture ---- */

/* Readable form of a file name: "wood-grain_2.png" is Wood grain 2. */
void wr_stamp_name(const char *path, WrText *out)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    wr_text_clear(out);
    for (size_t i = 0; i < length; i++) {
        char c = name[i] == '-' || name[i] == '_' ? ' ' : name[i];
        wr_text_addf(out, "%c", i == 0 && c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    }
}

static int index_of(const WrApp *app, const char *path)
{
    for (int i = 0; path && i < app->stamp->stamps.count; i++)
        if (strcmp(app->stamp->stamps.data[i].path, path) == 0) return i;
    return -1;
}

/* Add a file opened by the user to the list. */
static int offer(WrApp *app, const char *path)
{
    int index = index_of(app, path);
    if (index >= 0 || !path) return index;
    add_stamp(app, path, "My own", "");
    return app->stamp->stamps.count - 1;
}

int wr_stamp_chosen(const WrApp *app)
{
    return index_of(app, app->stamp->tip_path);
}

static bool is_carved(const WrApp *app, int index)
{
    return strncmp(app->stamp->stamps.data[index].words, "lower", 5) == 0;
}

SDL_Texture *wr_stamp_picture(WrApp *app, int index, int side)
{
    const WrThumbSource of = { .stamp = app->stamp->stamps.data[index].path,
                               .lower = is_carved(app, index) };
    return wr_thumb(app, WR_THUMB_STAMP, index, side, &of);
}

bool wr_stamp_choose(WrApp *app, int index)
{
    WrBrush *brush = &app->settings->brush;
    int tool = wr_tool_find(app, WR_ACT(stamp));
    if (app->tool != tool) wr_tool_choose(app, tool);
    if (!use_picture(app, index < 0 ? NULL : app->stamp->stamps.data[index].path)) return false;
    bool either = brush->mode == WR_BRUSH_RAISE || brush->mode == WR_BRUSH_LOWER;
    if (index >= 0 && either) brush->mode = is_carved(app, index) ? WR_BRUSH_LOWER : WR_BRUSH_RAISE;
    return true;
}

void wr_stamp_hover(WrApp *app, double u, double v, bool over)
{
    app->stamp->placed = over;
    app->stamp->u = u;
    app->stamp->v = v;
    wr_app_redraw(app);
}

/* a picture in the option row that opens the list */
static void stamp_picker(WrApp *app)
{
    wr_stamps_find(app);
    int chosen = offer(app, app->stamp->tip_path);
    SDL_Texture *picture = chosen < 0 ? wr_thumb_of(app, -1, wr_gui_px(52))
                                      : wr_stamp_picture(app, chosen, wr_gui_px(52));
    wr_gui_same_line(12);
    wr_gui_centre(wr_gui_px(32));
    if (wr_gui_tile("picture", picture, wr_gui_px(32), false, false)) {
        app->shelf->kind = WR_STOCK_STAMPS;
        wr_action_run(app, WR_ACT(brushes));
    }
    wr_gui_centre_end(wr_gui_px(32));
    wr_gui_tip("Click to choose a picture; the wheel sizes the stamp");
    wr_gui_same_line(6);
    wr_gui_centre(wr_gui_px(28));
    if (wr_gui_glyph("open", WR_ICON_FOLDER, 28, WR_COLOUR_LABEL))
        wr_action_run(app, WR_ACT(stamp_open));
    wr_gui_centre_end(wr_gui_px(28));
    wr_gui_tip("Open a picture, a .gbr or a .gih as a stamp");
}
