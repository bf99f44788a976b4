/* Dialog that bakes a detailed mesh onto the active object's. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/jobs/files.h"
#include "ui/panels/panels.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/enum_rows.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/bake.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GLYPH 24

void wr_file_take_bake(WrApp *app, const char *path)
{
    snprintf(app->forms->bake_file, sizeof app->forms->bake_file, "%s", path);
    wr_dialog_open(app, WR_DIALOG_BAKE);
}

static void choose_file(WrApp *app)
{
    const char *file = app->forms->bake_file;
    char *folder = *file ? wr_path_folder(file) : NULL;
    if (!wr_files_request_path(app->files, WR_FILE_BAKE, folder, ""))
        wr_dialog_open(app, WR_DIALOG_FILE);
    wr_free(folder);
}

static void file_row(WrApp *app)
{
    const char *path = app->forms->bake_file, *slash = strrchr(path, '/');
    wr_gui_label("Detailed mesh");
    const double end = wr_gui_place() + wr_gui_available();
    wr_gui_text_cut(WR_FONT_TEXT, *path ? WR_COLOUR_TEXT : WR_COLOUR_LABEL,
                    slash   ? slash + 1
                    : *path ? path
                            : "none",
                    wr_gui_available() - wr_gui_px(GLYPH + 4));
    if (*path) wr_gui_tip(path);
    wr_gui_same_line(4);
    wr_gui_move_to(end - wr_gui_px(GLYPH));
    if (wr_gui_glyph("choose", WR_ICON_FOLDER, GLYPH, WR_COLOUR_LABEL)) choose_file(app);
    wr_gui_tip("Choose a detailed mesh, with the position and unit of the object's mesh");
}

static void number(const char *label, const WrNumber *spec, double *value)
{
    wr_gui_label(label);
    wr_gui_number(label, 0, spec, value);
}

static void map_row(WrForms *f)
{
    WR_ROWS(titles);
    static const char *const titles[] = { [WR_ROW(WR_BAKE_HEIGHT)] = "Relief, as a layer",
                                          [WR_ROW(WR_BAKE_NORMAL)] = "Normals",
                                          [WR_ROW(WR_BAKE_OBJECT_NORMAL)] =
                                              "Normals in the object's axes",
                                          [WR_ROW(WR_BAKE_POSITION)] = "Positions",
                                          [WR_ROW(WR_BAKE_OCCLUSION)] = "Ambient occlusion",
                                          [WR_ROW(WR_BAKE_CURVATURE)] = "Curvature",
                                          [WR_ROW(WR_BAKE_PARTS)] = "Parts",
                                          [WR_ROW(WR_BAKE_HITS)] = "Hits and misses" };
    WR_ROWS_END(titles, WR_BAKE_KINDS);
    wr_gui_label("Map");
    wr_gui_choice("map", 0, titles, WR_BAKE_KINDS, &f->bake_map);
    wr_gui_note(WR_COLOUR_LABEL, wr_bakes[f->bake_map].help, 2);
}

static void cage_row(const WrApp *app, WrForms *f)
{
    static const char *const ways[] = { "Automatic", "Distance" };
    const double radius = wr_app_scene(app)->triangles->radius;
    const WrNumber spec = { .low = 1e-3 * radius,
                            .high = radius,
                            .hard_low = 1e-9 * radius,
                            .hard_high = 1e9,
                            .reset = 0.05 * radius,
                            .decimals = -1,
                            .logarithmic = true,
                            .tip = "Largest distance of the detailed mesh from the object, "
                                   "outwards and inwards, in the mesh's unit" };
    int way = f->bake_cage > 0;
    wr_gui_label("Cage");
    if (wr_gui_choice("cage", 0, ways, 2, &way)) f->bake_cage = way ? 0.05 * radius : 0;
    wr_gui_tip("Chooses just enough for the whole detailed mesh");
    if (way) number("Distance", &spec, &f->bake_cage);
}

static void size_row(const WrApp *app, WrForms *f)
{
    static const int sides[] = { 0, 256, 512, 1024, 2048, 4096, 8192 };
    const char *names[WR_LENGTH(sides)];
    char texts[WR_LENGTH(sides)][32];
    int chosen = 0;
    const WrField *field = wr_app_field(app);
    for (int i = 0; i < WR_LENGTH(sides); i++) {
        const int w = i ? sides[i] : wr_field_width(field);
        const int h = i ? sides[i] : wr_field_height(field);
        snprintf(texts[i], sizeof texts[i], "%d \xc3\x97 %d", w, h);
        names[i] = texts[i];
        if (f->bake_size == sides[i]) chosen = i;
    }
    if (f->bake_map == WR_BAKE_HEIGHT) return; /* a layer has the table's size */
    wr_gui_label("Size");
    if (wr_gui_choice("size", 0, names, WR_LENGTH(sides), &chosen)) f->bake_size = sides[chosen];
    wr_gui_tip("Size of the picture in texels; the first is the table's");
}

static void add_line(const WrForms *f, int map, WrText *line)
{
    wr_text_add(line, "bake ");
    wr_text_add_word(line, f->bake_file);
    wr_text_addf(line, " map=%s", wr_bakes[map].name);
    if (f->bake_cage > 0) wr_line_number(line, "cage", f->bake_cage);
    wr_text_addf(line, " samples=%d padding=%d", (int)f->bake_samples, (int)f->bake_padding);
    if (f->bake_size && map != WR_BAKE_HEIGHT)
        wr_text_addf(line, " size=%dx%d", f->bake_size, f->bake_size);
    if (f->bake_match) wr_text_add(line, " match=name");
}

static void run(WrApp *app, int map)
{
    WrText line = { 0 };
    add_line(app->forms, map, &line);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_dialog_bake(WrApp *app)
{
    static const WrNumber samples = { .low = 1,
                                      .high = WR_BAKE_SAMPLES_MAX,
                                      .hard_low = 1,
                                      .hard_high = WR_BAKE_SAMPLES_MAX,
                                      .reset = 2,
                                      .tip =
                                          "Rays per texel along each side; their mean is stored" };
    static const WrNumber padding = {
        .low = 0,
        .high = WR_BAKE_PADDING_MAX,
        .hard_low = 0,
        .hard_high = WR_BAKE_PADDING_MAX,
        .reset = 8,
        .unit = "texels",
        .tip = "Width of the margin around the islands of (u,v), and into holes"
    };
    static const char *const matches[] = { "All parts", "Parts of the same name" };
    WrForms *f = app->forms;
    if (!wr_app_can_bake(app)) { /* another object was chosen meanwhile */
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin("Bake a detailed mesh", 460)) return;
    const bool ready = f->bake_file[0] != '\0';
    file_row(app);
    map_row(f);
    cage_row(app, f);
    number("Samples", &samples, &f->bake_samples);
    size_row(app, f);
    number("Padding", &padding, &f->bake_padding);
    wr_gui_label("Rays meet");
    wr_gui_choice("match", 0, matches, 2, &f->bake_match);
    wr_gui_tip("Each part meets only parts of the same name, not counting an ending _low or _high");
    wr_gui_label("");
    wr_gui_disable(!ready);
    if (wr_gui_chip(NULL, "Show where rays miss")) {
        wr_dialog_close(app);
        run(app, WR_BAKE_HITS);
    }
    wr_gui_disable_end();
    wr_gui_tip("Colours the object: green where rays hit, red where they miss, blue where they hit "
               "only back faces. Undo removes the colours");
    WrText line = { 0 };
    add_line(f, f->bake_map, &line);
    const bool agreed = wr_dialog_buttons(app, "Bake", ready) > 0;
    wr_panel_estimate(app, wr_text_get(&line));
    wr_text_fini(&line);
    if (agreed) run(app, f->bake_map);
    wr_gui_dialog_end();
}
