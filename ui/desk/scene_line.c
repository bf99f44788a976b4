/* One command for what was dragged in the scene. */
#include "ui/desk/scene_line.h"
#include "ui/desk/busy.h"
#include "ui/desk/desk.h"
#include "ui/desk/roster.h"
#include "ui/desk/session_view.h"

#include "base/text.h"

void wr_scene_run(WrApp *app, WrText *line)
{
    wr_app_settle(app); /* a zoom that waits lives in the same scene */
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(line));
    wr_text_fini(line);
}
