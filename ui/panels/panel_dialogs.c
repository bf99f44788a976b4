/* Dialogs that ask for a decision. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panels.h"
#include "ui/patch/patch.h"
#include "ui/app/jobs/files.h"

#include "base/enum_rows.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/variants.h"
#include "document/document_file.h"
#include "export/export.h"
#include "export/film.h"
#include "surface/surface.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void wr_dialog_unsaved(WrApp *app)
{
    char text[400];
    if (!wr_gui_dialog_begin("Save the changes?", 420)) return;
    snprintf(text, sizeof text, wr_words("%.200s has unsaved changes, which would be lost."),
             wr_app_name(app));
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, text);
    wr_gui_space(8);
    bool key = !app->dialog->fresh;
    if (wr_gui_button("Save", true) || (key && wr_gui_return_pressed())) {
        wr_dialog_close(app);
        wr_action_run(app, WR_ACT(save));
    }
    wr_gui_same_line(8);
    if (wr_gui_button("Discard", false) || (key && wr_gui_letter_pressed(SDL_SCANCODE_D))) {
        wr_dialog_close(app);
        wr_app_go_on(app);
    }
    wr_gui_tip("D");
    wr_gui_same_line(8);
    if (wr_gui_button("Cancel", false) || (key && wr_gui_escape_pressed())) {
        wr_dialog_close(app);
        app->file->after = WR_AFTER_NOTHING;
    }
    wr_panel_estimate(app, "save x.exr");
    wr_gui_dialog_end();
}

static void number(const char *label, double low, double high, double hard_low, double hard_high,
                   double reset, int decimals, const char *unit, double *value)
{
    WrNumber spec = { .low = low,
                      .high = high,
                      .hard_low = hard_low,
                      .hard_high = hard_high,
                      .reset = reset,
                      .decimals = decimals,
                      .unit = unit };
    wr_gui_label(label);
    wr_gui_number(label, 0, &spec, value);
}

/* Draw the buttons and the memory estimate, run the line if confirmed; frees the line. */
static void run_if_agreed(WrApp *app, WrText *line, const char *done)
{
    const bool agreed = wr_dialog_buttons(app, done, true) > 0;
    wr_panel_estimate(app, wr_text_get(line));
    if (agreed) wr_app_run_slow(app, wr_text_get(line));
    wr_text_fini(line);
}

void wr_dialog_table(WrApp *app)
{
    static const char *const wraps[] = { "Repeats both ways", "Ends at left and right",
                                         "Ends at top and bottom", "Ends all around" };
    _Static_assert(WR_LENGTH(wraps) == WR_DOCUMENT_WRAPS, "in the order of their words");
    WrForms *f = app->forms;
    if (!wr_gui_dialog_begin("New table", 400)) return;
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                        "A table of this size at height 0 replaces the present one. The scene "
                        "stays.");
    number("Width", 16, 4096, 1, 16384, 512, 0, "texels", &f->width);
    number("Height", 16, 4096, 1, 16384, 512, 0, "texels", &f->height);
    wr_gui_label("Edges");
    wr_gui_choice("wrap", 0, wraps, WR_DOCUMENT_WRAPS, &f->wrap);
    WrText line = { 0 };
    wr_text_addf(&line, "table %dx%d wrap=%s", (int)rint(f->width), (int)rint(f->height),
                 wr_document_wrap_name(f->wrap));
    run_if_agreed(app, &line, "Make it");
    wr_gui_dialog_end();
}

void wr_dialog_fill(WrApp *app)
{
    if (!wr_gui_dialog_begin("Fill the table", 360)) return;
    number("Height", 0, 1, -1e30, 1e30, 0, 3, NULL, &app->forms->fill);
    WrText line = { 0 };
    wr_text_add(&line, "fill ");
    wr_text_add_number(&line, app->forms->fill);
    run_if_agreed(app, &line, "Fill");
    wr_gui_dialog_end();
}

void wr_dialog_grid(WrApp *app)
{
    WrForms *f = app->forms;
    if (!wr_gui_dialog_begin("Grid", 380)) return;
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                        "A grid of lines on cells. Replaces the heights.");
    number("Cells across", 1, 32, 1, 16384, 8, 0, NULL, &f->cells_u);
    number("Cells down", 1, 32, 1, 16384, 8, 0, NULL, &f->cells_v);
    number("Line width", 0, 64, 0, 16384, 8, 1, "texels", &f->line_width);
    number("Cells' height", 0, 1, -1e30, 1e30, 0, 3, NULL, &f->low);
    number("Lines' height", 0, 1, -1e30, 1e30, 1, 3, NULL, &f->high);
    WrText line = { 0 };
    wr_text_addf(&line, "grid cells=%dx%d", (int)rint(f->cells_u), (int)rint(f->cells_v));
    wr_line_number(&line, "width", f->line_width);
    wr_line_number(&line, "low", f->low);
    wr_line_number(&line, "high", f->high);
    run_if_agreed(app, &line, "Draw");
    wr_gui_dialog_end();
}

void wr_dialog_import(WrApp *app)
{
    static const char *const fits[] = { "The table takes its size",
                                        "The picture is resampled to the table" };
    int fit = app->forms->fit;
    if (!wr_gui_dialog_begin("Import heights", 420)) return;
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                        "Any picture: grey, or the luma of its colours. 8 and 16 bits give heights "
                        "from 0 to 1, float files their values.");
    wr_gui_label("Picture");
    if (wr_gui_choice("fit", 0, fits, 2, &fit)) app->forms->fit = fit == 1;
    if (wr_dialog_buttons(app, "Choose a file...", true) > 0 &&
        !wr_files_request_path(app->files, WR_FILE_IMPORT, NULL, ""))
        wr_dialog_open(app, WR_DIALOG_FILE);
    wr_gui_dialog_end();
}

/* True if the active object is a mesh, or another surface of triangles. */
static bool has_mesh(const WrApp *app)
{
    return wr_surfaces[wr_app_scene(app)->shape.kind]->held;
}

static void add_export_line(const WrApp *app, const char *path, WrText *line)
{
    WR_ROWS(ranges);
    static const char *const ranges[] = { [WR_ROW(WR_RANGE_AUTO)] = "auto",
                                          [WR_ROW(WR_RANGE_UNIT)] = "0,1",
                                          [WR_ROW(WR_RANGE_SIGNED)] = "signed" };
    WR_ROWS_END(ranges, WR_RANGES);
    const WrForms *f = app->forms;
    const WrExportKind *kind = &wr_export_kinds[f->kind];
    wr_text_addf(line, "export %s ", kind->name);
    wr_text_add_word(line, path);
    if (strcmp(kind->name, "height") == 0) wr_text_addf(line, " range=%s", ranges[f->range]);
    if (kind->solid && has_mesh(app)) {
        if (f->mesh_size > 0) wr_line_number(line, "size", f->mesh_size);
        wr_line_number(line, "error", f->solid_error);
        if (f->mesh_round) wr_text_add(line, " edges=round");
        if (f->mesh_limited) wr_text_add(line, " folds=limit");
    } else if (kind->solid) {
        wr_line_number(line, "size", f->solid_size);
        wr_line_number(line, "error", f->solid_error);
        if (f->solid_thickness > 0) wr_line_number(line, "thickness", f->solid_thickness);
    }
    if (f->export_more[0]) wr_text_addf(line, " %s", f->export_more);
}

void wr_file_take_export(WrApp *app, const char *path)
{
    WrText line = { 0 };
    add_export_line(app, path, &line);
    if (wr_app_run_line(app, wr_text_get(&line)) && app->messages->list.count == 0)
        wr_app_say(app, "Exported %s", path);
    wr_text_fini(&line);
}

/* The row of dialogs that can write a file for each variant. */
static void variants_row(const WrApp *app)
{
    if (!wr_variant_count(wr_app_document(app))) return;
    wr_gui_check("All variants, a file for each", &app->forms->all_variants);
    wr_gui_tip("<VARIANT> in the file name is replaced by the name of each variant");
}

/* Ask for the name of a file; of one for each variant if that was chosen. */
static void ask_file(WrApp *app, WrFilePurpose purpose, const char *name)
{
    const bool all = app->forms->all_variants && wr_variant_count(wr_app_document(app)) > 0;
    char *pattern = all ? wr_variant_insert(name) : wr_strdup(name);
    if (!wr_files_request_path(app->files, purpose, NULL, pattern))
        wr_dialog_open(app, WR_DIALOG_FILE);
    wr_free(pattern);
}

static void ask_export_file(WrApp *app, const char *ending)
{
    char name[24];
    snprintf(name, sizeof name, "%s.%s", ending ? "relief" : "height", ending ? ending : "png");
    ask_file(app, WR_FILE_EXPORT, name);
}

static void mesh_numbers(WrForms *f)
{
    static const char *const edges[] = { "stay sharp", "become round" };
    static const char *const folds[] = { "are kept and counted", "are lowered" };
    number("Size", 0, 300, 0, 1e4, 0, 1, "mm", &f->mesh_size);
    number("Error", 0.01, 1, 0.001, 100, 0.05, 3, "mm", &f->solid_error);
    wr_gui_label("Hard edges");
    wr_gui_choice("edges", 0, edges, 2, &f->mesh_round);
    wr_gui_label("Folds");
    wr_gui_choice("folds", 0, folds, 2, &f->mesh_limited);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                        "Size 0: size and position by the file's unit. Otherwise it is the longest "
                        "side without relief. Folds are places where the relief overlaps itself.");
}

static void solid_numbers(WrForms *f)
{
    number("Size", 10, 300, 1, 1e4, 100, 1, "mm", &f->solid_size);
    number("Error", 0.01, 1, 0.001, 100, 0.05, 3, "mm", &f->solid_error);
    number("Thickness", 0, 10, 0, 1e3, 0, 2, "mm", &f->solid_thickness);
    wr_gui_text_wrapped(
        WR_FONT_SMALL, WR_COLOUR_LABEL,
        "Size is the longest side of the surface without its relief. Error is the largest distance "
        "of a texel from its triangle. Thickness 0: 2 mm under a sheet; tubes are solid.");
}

void wr_dialog_export(WrApp *app)
{
    WR_ROWS(ranges);
    static const char *const ranges[] = { [WR_ROW(WR_RANGE_AUTO)] = "Lowest to highest",
                                          [WR_ROW(WR_RANGE_UNIT)] = "0 to 1, others clipped",
                                          [WR_ROW(WR_RANGE_SIGNED)] = "Signed, 0 in the middle" };
    WR_ROWS_END(ranges, WR_RANGES);
    const char *kinds[WR_EXPORT_KIND_COUNT];
    WrForms *f = app->forms;
    if (!wr_gui_dialog_begin("Export", 440)) return;
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++) kinds[i] = wr_export_kinds[i].label;
    wr_gui_label("What");
    wr_gui_choice("kind", 0, kinds, WR_EXPORT_KIND_COUNT, &f->kind);
    wr_gui_note(WR_COLOUR_LABEL, wr_export_kinds[f->kind].help, 2);
    if (wr_export_kinds[f->kind].prepare) { /* the kind has a range */
        wr_gui_label("Black and white");
        wr_gui_choice("range", 0, ranges, WR_RANGES, &f->range);
    }
    if (wr_export_kinds[f->kind].solid && has_mesh(app)) mesh_numbers(f);
    else if (wr_export_kinds[f->kind].solid) solid_numbers(f);
    else if (wr_export_kinds[f->kind].channels > 0)
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            "The file name's extension chooses the format: png and tif have 16 "
                            "bits, exr floats, jpg 8 bits.");
    wr_gui_label("More");
    wr_gui_hint_field("##more", "repeat=2x2 resize=pot border=on", 0, f->export_more,
                      sizeof f->export_more);
    wr_gui_tip(
        "Options of the command `export`; F1 lists them.\nExport maps (Ctrl+Alt+M) writes whole "
        "sets, with a picture of each map.");
    variants_row(app);
    WrText line = { 0 };
    add_export_line(app, "x.png", &line);
    const bool agreed = wr_dialog_buttons(app, "Choose a file...", true) > 0;
    wr_panel_estimate(app, wr_text_get(&line));
    wr_text_fini(&line);
    if (agreed) ask_export_file(app, wr_export_kinds[f->kind].ending);
    wr_gui_dialog_end();
}

/* Append the command for the picture with the view's present rotation. */
static void add_render_line(const WrApp *app, const char *path, WrText *line)
{
    wr_text_add(line, "render ");
    wr_text_add_word(line, path);
    wr_text_addf(line, " size=%dx%d", (int)rint(app->forms->picture_width),
                 (int)rint(app->forms->picture_height));
    wr_line_number(line, "turn", app->patch->turn_deg);
}

void wr_dialog_render(WrApp *app)
{
    WrForms *f = app->forms;
    WrText line = { 0 };
    if (!wr_gui_dialog_begin("Render a picture", 440)) return;
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                        "A picture of the scene in the present view. Large pictures are rendered "
                        "in bands, with little memory.");
    number("Width", 16, 4096, 1, 16384, 2048, 0, "pixels", &f->picture_width);
    number("Height", 16, 4096, 1, 16384, 2048, 0, "pixels", &f->picture_height);
    wr_gui_text_wrapped(
        WR_FONT_SMALL, WR_COLOUR_LABEL,
        "The file name's extension chooses the format: exr and tif store linear floats with "
        "coverage, png, jpg and others 8-bit sRGB over the background.");
    variants_row(app);
    add_render_line(app, "x.png", &line);
    const bool agreed = wr_dialog_buttons(app, "Choose a file...", true) > 0;
    wr_panel_estimate(app, wr_text_get(&line));
    wr_text_fini(&line);
    if (agreed) ask_file(app, WR_FILE_RENDER, "picture.png");
    wr_gui_dialog_end();
}

void wr_file_take_render(WrApp *app, const char *path)
{
    WrText line = { 0 };
    add_render_line(app, path, &line);
    if (wr_app_run_line(app, wr_text_get(&line)) && app->messages->list.count == 0)
        wr_app_say(app, "Rendered %s", path);
    wr_text_fini(&line);
}

/* ---- turntable film ---- */

/* Append a full turn that starts at the view's present rotation. */
static void add_film_line(const WrApp *app, const char *path, WrText *line)
{
    const WrForms *f = app->forms;
    wr_text_add(line, "render ");
    wr_text_add_word(line, path);
    wr_text_addf(line, " size=%dx%d frames=%d", (int)rint(f->film_width), (int)rint(f->film_height),
                 (int)rint(f->film_frames));
    wr_line_number(line, "fps", f->film_fps);
    wr_line_number(line, "turn", app->patch->turn_deg);
}

static void film_numbers(WrForms *f)
{
    const char *kinds[WR_FILM_KIND_COUNT];
    char text[120];
    for (int i = 0; i < WR_FILM_KIND_COUNT; i++) kinds[i] = wr_film_kinds[i].name;
    wr_gui_label("Format");
    wr_gui_choice("film", 0, kinds, WR_FILM_KIND_COUNT, &f->film_kind);
    const double most = wr_film_kinds[f->film_kind].most_fps;
    number("Frames", 2, 360, 1, 100000, 120, 0, NULL, &f->film_frames);
    number("Rate", 1, 60, 0.1, most, 25, 2, "a second", &f->film_fps);
    number("Width", 16, 1920, 1, 8192, 640, 0, "pixels", &f->film_width);
    number("Height", 16, 1920, 1, 8192, 640, 0, "pixels", &f->film_height);
    if (f->film_fps > most) f->film_fps = most;
    wr_words_print(text, sizeof text, wr_words("%.4g seconds, %.3g degrees per frame."),
                   f->film_frames / f->film_fps, 360.0 / f->film_frames);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

void wr_dialog_film(WrApp *app)
{
    WrForms *f = app->forms;
    WrText line = { 0 };
    char name[24];
    if (!wr_gui_dialog_begin("Save a turntable as a film", 440)) return;
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                        "One turn about the world's vertical axis, starting from the present view. "
                        "Films are made by the program ffmpeg.");
    film_numbers(f);
    variants_row(app);
    add_film_line(app, "x.png", &line);
    const bool agreed = wr_dialog_buttons(app, "Choose a file...", true) > 0;
    wr_panel_estimate(app, wr_text_get(&line));
    wr_text_fini(&line);
    snprintf(name, sizeof name, "turn.%s", wr_film_kinds[f->film_kind].ending);
    if (agreed) ask_file(app, WR_FILE_FILM, name);
    wr_gui_dialog_end();
}

void wr_file_take_film(WrApp *app, const char *path)
{
    WrText line = { 0 };
    add_film_line(app, path, &line);
    wr_app_run_line(app, wr_text_get(&line)); /* its note names the written files */
    wr_text_fini(&line);
}

/* A line with the cost of the file operation, for any file name; "" if it is instant. */
static void file_line(const WrApp *app, WrText *line)
{
    const WrFilePurpose of = wr_files_purpose(app->files);
    if (of == WR_FILE_SAVE) wr_text_add(line, "save x.exr");
    if (of == WR_FILE_EXPORT) add_export_line(app, "x.png", line);
    if (of == WR_FILE_RENDER) add_render_line(app, "x.png", line);
    if (of == WR_FILE_FILM) add_film_line(app, "x.mp4", line);
}

void wr_dialog_file(WrApp *app)
{
    char takes[WR_EXPECTATION] = "";
    WrText line = { 0 };
    file_line(app, &line);
    if (line.length > 0) wr_expectation(app, wr_text_get(&line), takes);
    wr_text_fini(&line);
    int answer = wr_files_panel(app->files, takes, app->settings->recent);
    if (answer == 0) return;
    wr_dialog_close(app);
    WrFilePurpose purpose;
    const char *path = wr_files_answer(app->files, &purpose);
    if (answer > 0 && path) wr_app_file_chosen(app, purpose, path);
    else app->file->after = WR_AFTER_NOTHING;
}
