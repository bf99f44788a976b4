#include "ui/app/state/scene_line.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"

#include "base/text.h"
#include "command/command_line.h"
#include "scene/param.h"
#include "scene/scene.h"

void wr_scene_run(WrApp *app, WrText *line)
{
    wr_app_settle(app); /* a delayed zoom is in the same live scene */
    wr_app_live_end(app);
    wr_app_run_line(app, wr_text_get(line));
    wr_text_fini(line);
}

void wr_scene_refit(WrApp *app)
{
    if (!wr_app_scene(app)->camera.fit) wr_action_run(app, WR_ACT(camera_fill));
}

void wr_line_param(WrText *line, const WrSceneParam *param, const double *values)
{
    wr_text_addf(line, " %s=", param->name);
    wr_param_text(param, values, line);
}

void wr_line_light(WrText *line, const WrLight *light, int index)
{
    const char *form = wr_light_kinds[light->kind].name;
    const WrSceneParam *param;
    wr_text_addf(line, "light %s", form);
    for (int i = 0; (param = wr_scene_param("light", form, i)) != NULL; i++) {
        double values[3];
        wr_scene_param_get(param, light, values);
        wr_line_param(line, param, values);
    }
    wr_text_addf(line, " index=%d", index + 1);
}
