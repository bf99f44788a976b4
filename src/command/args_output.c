/* Arguments of the commands that write files. */
#include "command/args.h"

#include "export/export.h"

const WrArgSpec wr_args_save[] = { { PLACE("FILE"), .type = WR_ARG_PATH,
                                     .help =
                                         "an OpenEXR file, *.exr, or an OpenRaster file, *.ora" },
                                   { 0 } };

static bool check_export_option(const void *ctx, const char *name, const char *value, WrError *err)
{
    WrExportOptions options = wr_export_default();
    return wr_export_option(ctx, &options, name, value, err);
}

bool wr_form_export(int i, WrForm *out)
{
    if (i >= WR_EXPORT_KIND_COUNT) return false;
    const WrExportKind *kind = &wr_export_kinds[i];
    *out = (WrForm){ .name = kind->name, .help = kind->help };
    for (int k = 0; k < WR_EXPORT_OPTIONS && kind->options[k].name; k++)
        out->args[k] = (WrArgSpec){ .name = kind->options[k].name,
                                    .type = WR_ARG_TEXT,
                                    .shape = kind->options[k].values,
                                    .help = kind->options[k].help,
                                    .check = check_export_option,
                                    .check_ctx = kind };
    return true;
}

const WrArgSpec wr_args_export[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "the format goes by its ending" }, { 0 }
};

const WrArgSpec wr_args_render[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH,
      .help = "exr and tiff hold linear float with coverage, others 8-bit sRGB" },
    { .name = "size",
      .type = WR_ARG_SIZE,
      .low = 1,
      .high = 16384,
      .fallback = NUMBERS(512, 512),
      .unit = "pixels",
      .help = "of the picture" },
    { 0 }
};
