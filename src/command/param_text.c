#include "command/param_text.h"

#include "base/text.h"
#include "command/args.h"
#include "scene/param.h"

void wr_param_text(const WrSceneParam *param, const double *values, WrText *text)
{
    if (param->components == 0) wr_text_add(text, wr_off_on[values[0] != 0]);
    for (int i = 0; i < param->components; i++) {
        if (i > 0) wr_text_add(text, ",");
        wr_text_add_number(text, values[i]);
    }
}
