/* Dialog for a new document: size, aspect ratio, surface and initial content. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/action.h"
#include "ui/app/state/line.h"
#include "ui/toolkit/gui.h"
#include "ui/app/jobs/files.h"
#include "ui/panels/panels.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "document/document_file.h"
#include "surface/surface.h"

#include <math.h>
#include <string.h>

static void side(const char *label, double *value)
{
    static const WrNumber spec = {
        .low = 16, .high = 4096, .hard_low = 1, .hard_high = 16384, .reset = 512, .unit = "texels"
    };
    wr_gui_label(label);
    wr_gui_number(label, 0, &spec, value);
}

static void size_rows(WrNewForm *form)
{
    static const int longest[] = { 256, 512, 1024, 2048, 4096 };
    static const char *const sizes[] = { "256", "512", "1024", "2048", "4096" };
    const char *aspects[WR_ASPECTS];
    double longer = fmax(form->width, form->height), w, h;
    int size = -1, aspect = -1;
    for (int i = 0; i < 5; i++)
        if (longest[i] == longer) size = i;
    for (int i = WR_ASPECTS - 1; i >= 0; i--) {
        aspects[i] = wr_aspects[i].label;
        wr_new_sides(i, longer, &w, &h);
        if (w == form->width && h == form->height) aspect = i;
    }
    wr_gui_label("Longer side");
    bool sized = wr_gui_segments("size", sizes, NULL, 5, &size);
    wr_gui_label("Shape");
    bool shaped = wr_gui_segments("aspect", aspects, NULL, WR_ASPECTS, &aspect);
    if (sized && aspect >= 0) wr_new_sides(aspect, longest[size], &form->width, &form->height);
    else if (sized) { /* a free aspect ratio is kept */ double by = longest[size] / longer;
        form->width = fmax(1.0, rint(form->width * by));
        form->height = fmax(1.0, rint(form->height * by));
    }
    if (shaped) wr_new_sides(aspect, longer, &form->width, &form->height);
    side("Width", &form->width);
    side("Height", &form->height);
}

static void surface_row(WrNewForm *form)
{
    const char *labels[WR_SURFACE_COUNT];
    int kinds[WR_SURFACE_COUNT], count = 0, now = 0;
    for (int i = 0; i < WR_SURFACE_COUNT; i++) {
        if (!wr_new_surface(i)) continue;
        if (i == form->surface) now = count;
        kinds[count] = i;
        labels[count++] = wr_surfaces[i]->label;
    }
    wr_gui_label("Patch");
    if (wr_gui_choice("patch", 0, labels, count, &now)) form->surface = kinds[now];
    wr_gui_tip("The surface with the table's relief");
}

void wr_dialog_new(WrApp *app)
{
    static const char *const wraps[] = { "Repeats both ways", "Ends at left and right",
                                         "Ends at top and bottom", "Ends all around" };
    _Static_assert(WR_LENGTH(wraps) == WR_DOCUMENT_WRAPS, "in the order of their words");
    WrNewForm *form = &app->forms->fresh;
    const char *starters[WR_STARTERS];
    if (!wr_gui_dialog_begin("New", 460)) return;
    size_rows(form);
    wr_gui_label("Edges");
    wr_gui_choice("wrap", 0, wraps, WR_DOCUMENT_WRAPS, &form->wrap);
    surface_row(form);
    for (int i = 0; i < WR_STARTERS; i++) starters[i] = wr_starters[i].label;
    wr_gui_label("Begin with");
    wr_gui_choice("starter", 0, starters, WR_STARTERS, &form->starter);
    wr_gui_tip("Content of the new document; it can be changed in Generate");
    wr_gui_space(4);
    if (wr_gui_button("From a picture...", false)) {
        wr_dialog_close(app);
        if (!wr_files_request_path(app->files, WR_FILE_OPEN, NULL, ""))
            wr_dialog_open(app, WR_DIALOG_FILE);
        wr_gui_dialog_end();
        return;
    }
    wr_gui_tip("Converts its greys to heights; the table takes its size");
    if (wr_dialog_buttons(app, "Make it", true) > 0) {
        WrText lines = { 0 };
        wr_new_document_lines(form, wr_document_wrap_name(form->wrap), &lines);
        wr_deferred(app, wr_app_new_of, wr_text_get(&lines));
        wr_text_fini(&lines);
    }
    wr_gui_dialog_end();
}
