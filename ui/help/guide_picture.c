#include "ui/help/guide_picture.h"
#include "ui/toolkit/gui_sdl.h"
#include "ui/jobs/job.h"

#include "base/array.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/image.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define PICTURES_FOLDER "ui/guide/" /* base folder of relative paths */

typedef struct Picture {
    char *path;           /* owned */
    SDL_Texture *texture; /* owned; NULL: not loaded yet, or failed */
    int width, height;
    bool tried;
} Picture;

struct WrGuidePictures {
    SDL_Renderer *renderer; /* borrowed */
    WrJob *job;
    WR_ARRAY(Picture) list;
    int made, index; /* number of loaded pictures; index of the one being read */
    bool reading;
};

typedef struct Work {
    char *path; /* owned */
    int width, height;
    uint32_t *argb; /* owned; NULL: unreadable */
} Work;

static void drop(void *arg)
{
    Work *work = arg;
    wr_free(work->path);
    wr_free(work->argb);
    wr_free(work);
}

static uint32_t code(const float *texel, int channel)
{
    return (uint32_t)(fmin(fmax((double)texel[channel], 0.0), 1.0) * 255.0 + 0.5);
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    (void)pool;
    (void)progress;
    Work *work = arg;
    WrText found = { 0 };
    WrImage *image =
        wr_data_find(work->path, &found) ? wr_image_read(wr_text_get(&found), NULL) : NULL;
    wr_text_fini(&found);
    if (!image) return;
    work->width = image->width;
    work->height = image->height;
    size_t count = (size_t)image->width * (size_t)image->height;
    int green = image->channels >= 3 ? 1 : 0, blue = image->channels >= 3 ? 2 : 0;
    work->argb = wr_alloc(count, sizeof *work->argb);
    for (size_t i = 0; i < count; i++) {
        const float *texel = image->data + i * (size_t)image->channels;
        work->argb[i] =
            0xff000000u | code(texel, 0) << 16 | code(texel, green) << 8 | code(texel, blue);
    }
    wr_image_free(image);
}

WrGuidePictures *wr_guide_pictures_new(SDL_Renderer *renderer, Uint32 done_event)
{
    static const WrJobKind kind = { run, drop };
    WrGuidePictures *pictures = wr_alloc(1, sizeof *pictures);
    pictures->renderer = renderer;
    pictures->job = wr_job_new(&kind, 1, done_event);
    return pictures;
}

void wr_guide_pictures_free(WrGuidePictures *pictures)
{
    if (!pictures) return;
    wr_job_free(pictures->job);
    for (int i = 0; i < pictures->list.count; i++) {
        if (pictures->list.data[i].texture) SDL_DestroyTexture(pictures->list.data[i].texture);
        wr_free(pictures->list.data[i].path);
    }
    wr_array_free(&pictures->list);
    wr_free(pictures);
}

static void take(WrGuidePictures *pictures)
{
    Work *work = wr_job_take(pictures->job);
    if (!work) return;
    Picture *picture = &pictures->list.data[pictures->index];
    pictures->reading = false;
    if (work->argb)
        picture->texture = SDL_CreateTexture(pictures->renderer, SDL_PIXELFORMAT_ARGB8888,
                                             SDL_TEXTUREACCESS_STATIC, work->width, work->height);
    if (picture->texture) {
        SDL_SetTextureScaleMode(picture->texture, SDL_ScaleModeLinear);
        wr_gui_sdl_update(picture->texture, NULL, work->argb, work->width * 4);
        picture->width = work->width;
        picture->height = work->height;
        pictures->made++;
    }
    drop(work);
}

static void go_on(WrGuidePictures *pictures)
{
    take(pictures);
    for (int i = 0; i < pictures->list.count && !pictures->reading; i++) {
        Picture *picture = &pictures->list.data[i];
        if (picture->tried) continue;
        Work *work = wr_alloc(1, sizeof *work);
        WrText path = { 0 };
        wr_text_addf(&path, PICTURES_FOLDER "%s", picture->path);
        work->path = wr_strdup(wr_text_get(&path));
        wr_text_fini(&path);
        picture->tried = pictures->reading = true;
        pictures->index = i;
        wr_job_start(pictures->job, work);
    }
}

SDL_Texture *wr_guide_picture(WrGuidePictures *pictures, const char *path, int *width, int *height)
{
    int at = 0;
    while (at < pictures->list.count && strcmp(pictures->list.data[at].path, path) != 0) at++;
    if (at == pictures->list.count)
        wr_array_push(&pictures->list, ((Picture){ .path = wr_strdup(path) }));
    go_on(pictures);
    *width = pictures->list.data[at].width;
    *height = pictures->list.data[at].height;
    return pictures->list.data[at].texture;
}

int wr_guide_pictures_made(const WrGuidePictures *pictures)
{
    return pictures->made;
}
