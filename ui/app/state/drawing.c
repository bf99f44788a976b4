#include "ui/app/state/drawing.h"

#include "ui/app/state/background_command.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/canvas/view.h"

#include "base/text.h"
#include "command/command_line.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"

#include <math.h>
#include <stddef.h>

#define PART 0.75 /* of the shorter side */

static void add_place(const WrApp *app, WrText *from)
{
    const WrCanvasView *view = app->view;
    const WrField *selection = wr_app_document(app)->selection;
    double at[2], side = fmin(view->table_w, view->table_h);
    WrSelectBox box;
    wr_view_middle(view, at);
    if (selection && wr_select_box(selection, &box)) {
        at[0] = (box.i + 0.5 * box.count_i) / view->table_w;
        at[1] = 1.0 - (box.j + 0.5 * box.count_j) / view->table_h;
        side = fmin(box.count_i, box.count_j);
    }
    wr_line_number(from, "at", wr_line_round(at[0], 6));
    wr_text_add(from, ",");
    wr_text_add_number(from, wr_line_round(at[1], 6));
    wr_line_number(from, "size", fmax(1.0, rint(PART * side)));
}

void wr_app_add_drawing(WrApp *app, const char *path, const char *data, const char *name)
{
    WrText from = { 0 }, line = { 0 };
    wr_text_add(&from, path ? "picture svg " : "picture path ");
    wr_text_add_word(&from, path ? path : data);
    add_place(app, &from);
    wr_text_add(&line, "layer add ");
    if (name) wr_text_add_word(&line, name);
    else wr_text_add_file_name(&line, path);
    wr_text_add(&line, " from=");
    wr_text_add_word(&line, wr_text_get(&from));
    if (wr_app_run_line(app, wr_text_get(&line)))
        wr_app_say(app, "Added as a generator layer; a double click on it opens its values");
    wr_text_fini(&from);
    wr_text_fini(&line);
}
