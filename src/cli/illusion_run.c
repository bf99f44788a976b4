#include "cli/illusion_run.h"

#include "accuracy/illusion.h"
#include "accuracy/ladder.h"
#include "base/memory.h"
#include "cli/cli.h"
#include "image/image.h"

#include <math.h>

bool wr_illusion_check(const WrCli *cli, WrError *err)
{
    if (cli->map && !cli->illusion)
        return wr_fail(err, "--map: accuracy writes the map of --illusion alone");
    if (cli->illusion && (cli->hard_cases || cli->tolerance_count > 0 || cli->csv ||
                          cli->plot_count > 0 || cli->differences))
        return wr_fail(err, "--illusion: goes with --size, --turn, --map and --json alone");
    return !cli->map || wr_image_can_write(cli->map, WR_PIXEL_U8, 3, true, err);
}

static bool write_map(const WrIllusion *it, const char *path, WrError *err)
{
    const size_t pixels = (size_t)it->width * (size_t)it->height;
    uint8_t *rgb = wr_try_alloc(pixels, 3, "the map", err);
    if (!rgb) return false;
    for (size_t i = 0; i < pixels; i++) wr_illusion_colour(it, i, rgb + 3 * i);
    const bool good =
        wr_image_write_pixels(path, it->width, it->height, 3, WR_PIXEL_U8, true, rgb, err);
    wr_free(rgb);
    return good;
}

bool wr_illusion_run(const WrCli *cli, const WrLadderRequest *request, const char *name,
                     WrText *text, WrError *err)
{
    const WrIllusionRequest wanted = { .fields = request->fields,
                                       .field = request->field,
                                       .scene = request->scene,
                                       .width = request->width,
                                       .height = request->height,
                                       .turn_deg = request->turn_deg,
                                       .threads = cli->threads,
                                       .isa = cli->isa,
                                       .progress = request->progress };
    WrIllusion it = { 0 };
    const bool good =
        wr_illusion_measure(&wanted, &it, err) && (!cli->map || write_map(&it, cli->map, err));
    if (good && cli->json) wr_illusion_json(&it, name, text);
    else if (good) wr_illusion_text(&it, name, text);
    wr_illusion_fini(&it);
    return good;
}
