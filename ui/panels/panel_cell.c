/* Unit cell section of the scene panel: physical size for exports. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"

#include "base/text.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/param.h"
#include "scene/scene.h"

#include <math.h>

static void run_cell(WrApp *app, const WrCellSize *cell)
{
    WrText line = { 0 };
    wr_text_add(&line, "cell ");
    wr_text_add_number(&line, cell->w);
    wr_text_add(&line, ",");
    wr_text_add_number(&line, cell->h);
    wr_text_addf(&line, " mm=%s", cell->mm ? "on" : "off");
    if (cell->mm) wr_line_number(&line, "height", cell->height);
    wr_scene_run(app, &line);
}

static WrEdit sides(WrCellSize *cell)
{
    const WrSceneParam *param = &wr_scene_params[WR_SCENE_PARAM_CELL_SIZE];
    const WrNumber spec = wr_param_slider(param);
    wr_gui_label(param->label);
    const double half = (wr_gui_available() - wr_gui_px(8)) / 2;
    const WrEdit w = wr_gui_number("cell w", half, &spec, &cell->w);
    wr_gui_same_line(8);
    const WrEdit h = wr_gui_number("cell h", half, &spec, &cell->h);
    return w > h ? w : h;
}

static WrEdit rows(WrCellSize *cell)
{
    static const char *const units[] = { "scene units", "mm" };
    int unit = cell->mm;
    WrEdit edit = sides(cell);
    wr_gui_label("Unit");
    if (wr_gui_choice("cell unit", 0, units, 2, &unit)) {
        cell->mm = unit == 1;
        edit = WR_EDIT_DONE;
    }
    wr_gui_tip("Size for exports and solids: in scene units, the relief has the height in Height");
    if (!cell->mm) return edit;
    const WrSceneParam *param = &wr_scene_params[WR_SCENE_PARAM_CELL_HEIGHT];
    const WrNumber spec = wr_param_slider(param);
    wr_gui_label(param->label);
    const WrEdit height = wr_gui_number("cell height", 0, &spec, &cell->height);
    return edit > height ? edit : height;
}

static void report_texel(const WrCellSize *cell, const WrField *field)
{
    char text[120];
    wr_words_print(text, sizeof text, wr_words("%.4g x %.4g %s a texel"),
                   cell->w / wr_field_width(field), cell->h / wr_field_height(field),
                   wr_words(cell->mm ? "mm" : "scene units"));
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

void wr_panel_cell(WrApp *app)
{
    WrCellSize cell = wr_app_scene(app)->cell;
    if (!wr_gui_fold("REAL-WORLD SIZE", false)) return;
    const WrEdit edit = rows(&cell);
    report_texel(&cell, wr_app_document(app)->layers[0].heights);
    if (edit == WR_EDIT_LIVE) wr_app_live_begin(app)->cell = cell;
    if (edit == WR_EDIT_DONE) run_cell(app, &cell);
}
