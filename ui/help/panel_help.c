/* Dialogs of the guide and of information about the program. */
#include "ui/help/panel_help.h"
#include "ui/state/app_state.h"
#include "ui/state/dialog.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/help/guide.h"

#include <math.h>

static void about(void)
{
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT,
                        "Paint bump functions and watch them wrinkle a surface, after James F. "
                        "Blinn, Simulation of Wrinkled Surfaces, 1978.");
}

void wr_dialog_help(WrApp *app)
{
    bool only_about = app->dialog->now == WR_DIALOG_ABOUT;
    if (!wr_gui_dialog_begin(only_about ? "Wrinkle" : "Guide", only_about ? 440 : 1060)) return;
    const bool asks = !only_about && wr_guide_proposed(app); /* its keys are Run and Cancel */
    if (only_about) about();
    else wr_guide_show(app, fmax(0.92 * app->height - wr_gui_px(180), wr_gui_px(120)));
    wr_gui_space(8);
    bool leave = wr_gui_button("Close", true);
    if (!app->dialog->fresh && !asks && (wr_gui_escape_pressed() || wr_gui_return_pressed()))
        leave = true;
    if (leave) wr_dialog_close(app);
    wr_gui_dialog_end();
}
