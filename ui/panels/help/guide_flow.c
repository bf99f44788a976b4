#include "ui/panels/help/guide_flow.h"
#include "ui/toolkit/gui_sdl_renderer.h"
#include "ui/app/jobs/job.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_page.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/help/guide_page.h"

#include "base/array.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/image.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- pictures of a page ---- */

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

/* The picture of that path, as written in a page; NULL if it is not loaded yet, or unreadable. */
static SDL_Texture *guide_picture(WrGuidePictures *pictures, const char *path, int *width,
                                  int *height)
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

/* number of loaded pictures, to detect new ones */
static int guide_pictures_made(const WrGuidePictures *pictures)
{
    return pictures->made;
}

/* ---- layout of words ---- */

#define MARGIN 16    /* units on both sides of the text */
#define INDENT 18    /* of items */
#define CELL_GAP 14  /* between columns */
#define LEADING 1.34 /* line height divided by the font size */
#define LINK WR_COLOUR_LINK
#define GROUND WR_COLOUR_GROUND
#define MARKED WR_COLOUR_MARKED

/* Text being laid out, word by word. */
typedef struct Flow {
    double left, right; /* pixels of the window, or of the page during layout without drawing */
    double x, y;        /* position of the next word; top of its line */
    double widest;      /* largest line width so far */
    double word;        /* widest word */
    WrFont font;
    WrColour colour;
    bool draw;
    const WrGuiPage *field; /* pointer state; NULL during layout without drawing */
    const char *link;       /* link under the pointer; NULL: none */
} Flow;

static double line_height(WrFont font)
{
    return rint(wr_gui_line_height(font) * LEADING);
}

/* Number of bytes of a word, at character boundaries, that fit into `room`; at least one character. */
static int bytes_in(WrFont font, char *word, int length, double room)
{
    while (length > 1) {
        char kept = word[length];
        word[length] = '\0';
        double width = wr_gui_text_width(font, word);
        word[length] = kept;
        if (width <= room) break;
        length--;
        while (length > 1 && ((unsigned char)word[length] & 0xc0) == 0x80) length--;
    }
    return length;
}

static WrFont font_of(const Flow *flow, WrGuideStyle style)
{
    return style == WR_GUIDE_STRONG ? WR_FONT_BOLD : flow->font;
}

static WrColour colour_of(const Flow *flow, const WrGuideSpan *span)
{
    if (span->link) return LINK;
    return span->style == WR_GUIDE_PLAIN ? flow->colour : WR_COLOUR_STRONG;
}

/* from: start of the background behind code, and of a link's clickable area. */
static void draw_word(Flow *flow, const WrGuideSpan *span, const char *word, double from,
                      double width)
{
    WrFont font = font_of(flow, span->style);
    double high = wr_gui_line_height(font), gap = rint((line_height(flow->font) - high) / 2);
    if (span->style == WR_GUIDE_LITERAL)
        wr_gui_draw_fill(from, flow->y + gap - 1, flow->x + width - from + 2, high + 2, GROUND, 2);
    const WrGuiPage *f = flow->field;
    bool pointed = span->link && f->hovered && f->pointer_x >= from &&
                   f->pointer_x < flow->x + width && f->pointer_y >= flow->y &&
                   f->pointer_y < flow->y + line_height(flow->font);
    if (pointed) {
        flow->link = span->link;
        wr_gui_draw_line(flow->x, flow->y + gap + high - 1, flow->x + width,
                         flow->y + gap + high - 1, LINK, 1);
    }
    wr_gui_draw_text(flow->x, flow->y + gap, font, colour_of(flow, span), word);
}

/* Lay out one word, with a gap before it if needed; a word wider than a line is split. */
static void set_word(Flow *flow, const WrGuideSpan *span, char *word, int length, double gap,
                     bool inside)
{
    WrFont font = font_of(flow, span->style);
    while (length > 0) {
        double from = flow->x;
        word[length] = '\0';
        double width = wr_gui_text_width(font, word);
        if (width > flow->word) flow->word = width;
        if (flow->x > flow->left && flow->x + gap + width > flow->right) {
            flow->x = from = flow->left;
            inside = false;
            flow->y += line_height(flow->font);
            gap = 0;
        }
        flow->x += gap;
        int fits = bytes_in(font, word, length, flow->right - flow->x);
        char kept = word[fits];
        word[fits] = '\0';
        if (fits < length) width = wr_gui_text_width(font, word);
        if (flow->draw) draw_word(flow, span, word, inside ? from + 2 : flow->x - 2, width);
        word[fits] = kept;
        flow->x += width;
        if (flow->x - flow->left > flow->widest) flow->widest = flow->x - flow->left;
        memmove(word, word + fits, (size_t)(length - fits));
        length -= fits;
        gap = 0;
    }
}

static void set_span(Flow *flow, const WrGuideSpan *span, const char *text)
{
    char word[400];
    double space = wr_gui_text_width(flow->font, " "), gap = 0;
    bool inside = false; /* a word of the same span precedes */
    for (int i = 0; i < span->length;) {
        int length = 0;
        if (text[i] == ' ') {
            gap = flow->x > flow->left ? space : 0;
            i++;
            continue;
        }
        while (i + length < span->length && text[i + length] != ' ' && length < 390) length++;
        memcpy(word, text + i, (size_t)length);
        set_word(flow, span, word, length, gap, inside);
        inside = true;
        gap = 0;
        i += length;
    }
    flow->x += gap;
}

/* Lay out a cell; returns its height. */
static double set_text(Flow *flow, const WrGuideCell *cell)
{
    double top = flow->y;
    const char *text = wr_text_get(&cell->text);
    flow->x = flow->left;
    for (int i = 0; i < cell->spans.count; i++) {
        set_span(flow, &cell->spans.data[i], text);
        text += cell->spans.data[i].length;
    }
    flow->y += line_height(flow->font);
    return flow->y - top;
}

/* Code wider than the line continues indented. */
static double set_code(Flow *flow, const char *text)
{
    WrGuideSpan span = { WR_GUIDE_PLAIN, 0, NULL };
    double top = flow->y;
    size_t indent = strspn(text, " ");
    text += indent;
    flow->x = flow->left + (double)indent * wr_gui_text_width(flow->font, "n");
    flow->left += wr_gui_px(INDENT);
    double hang = flow->left;
    if (flow->x < hang) { /* the first line starts at the left */
        flow->left = flow->x;
        char word[400];
        int length = (int)strcspn(text, " ");
        if (length > 390) length = 390;
        memcpy(word, text, (size_t)length);
        set_word(flow, &span, word, length, 0, false);
        text += length;
        flow->left = hang;
    }
    span.length = (int)strlen(text);
    set_span(flow, &span, text);
    flow->y += line_height(flow->font);
    return flow->y - top;
}

/* At the right end of a command's first line; its link is the command itself. */
static void set_run(Flow *flow, const WrGuideBlock *block)
{
    const char *word = wr_words("Run");
    const double width = wr_gui_text_width(flow->font, word);
    const WrGuideSpan span = { WR_GUIDE_PLAIN, 0, block->cells.data[0].text.data };
    flow->x = flow->right - width;
    if (flow->draw) draw_word(flow, &span, word, flow->x, width);
    flow->right -= width + wr_gui_px(10);
}

void wr_guide_run_at(const WrGuideLayout *layout, const WrGuiPage *field, int block, double *x,
                     double *y)
{
    *x = field->x + layout->width - wr_gui_px(MARGIN) - wr_gui_px(10) -
         wr_gui_text_width(WR_FONT_TEXT, wr_words("Run")) / 2;
    *y = field->y + layout->places.data[block].y + line_height(WR_FONT_TEXT) / 2;
}

/* ---- layout of blocks ---- */

static WrFont font_for(const WrGuideBlock *block)
{
    return block->kind == WR_GUIDE_HEADING ? WR_FONT_BOLD : WR_FONT_TEXT;
}

static WrColour colour_for(const WrGuideBlock *block)
{
    if (block->kind == WR_GUIDE_HEADING || block->kind == WR_GUIDE_CODE) return WR_COLOUR_STRONG;
    return block->kind == WR_GUIDE_ROW && block->level == 1 ? WR_COLOUR_LABEL : WR_COLOUR_TEXT;
}

/* Units above a block. */
static double space_above(const WrGuideBlock *block, bool first)
{
    if (first) return MARGIN;
    switch (block->kind) {
    case WR_GUIDE_HEADING: return block->level == 1 ? 10 : block->level == 2 ? 22 : 16;
    case WR_GUIDE_ITEM: return 4;
    default: return block->joined ? 0 : 9;
    }
}

/* Preferred and smallest width of each column of a table. */
static void measure(const WrGuidePage *page, int first, double want[], double least[], int *columns)
{
    *columns = 0;
    for (int k = 0; k < WR_GUIDE_CELLS; k++) want[k] = least[k] = 0;
    for (int i = first; i < page->blocks.count; i++) {
        const WrGuideBlock *row = &page->blocks.data[i];
        if (row->kind != WR_GUIDE_ROW || (i > first && !row->joined)) break;
        if (row->cells.count > *columns) *columns = row->cells.count;
        for (int k = 0; k < row->cells.count; k++) {
            Flow flow = { .right = 1e9, .font = font_for(row) };
            set_text(&flow, &row->cells.data[k]);
            want[k] = fmax(want[k], ceil(flow.widest) + 1);
            least[k] = fmax(least[k], ceil(flow.word) + 1);
        }
    }
}

/* Distribute `room` to the columns: their preferred widths if they fit, else their widest words and a share of the
   rest. */
static void share(double column[], const double want[], const double least[], int columns,
                  double room)
{
    double wanted = 0, needed = 0, more = 0;
    for (int k = 0; k < columns; k++) {
        double floor_k = fmin(least[k], 0.4 * room);
        wanted += want[k];
        needed += floor_k;
        more += want[k] - floor_k;
    }
    for (int k = 0; k < columns; k++) {
        double floor_k = fmin(least[k], 0.4 * room);
        if (wanted <= room) column[k] = want[k];
        else if (needed >= room) column[k] = floor_k * room / needed;
        else column[k] = floor_k + (room - needed) * (want[k] - floor_k) / more;
    }
}

static void place_columns(WrGuideLayout *layout, int first, double room)
{
    double want[WR_GUIDE_CELLS], least[WR_GUIDE_CELLS], column[WR_GUIDE_CELLS] = { 0 };
    int columns;
    measure(layout->page, first, want, least, &columns);
    share(column, want, least, columns, room - (columns - 1) * wr_gui_px(CELL_GAP));
    for (int i = first; i < layout->page->blocks.count; i++) {
        const WrGuideBlock *row = &layout->page->blocks.data[i];
        if (row->kind != WR_GUIDE_ROW || (i > first && !row->joined)) break;
        memcpy(layout->places.data[i].column, column, sizeof column);
    }
}

/* Lay out a block, drawn or not; returns its height. */
static double set_block(const WrGuideBlock *block, const WrGuidePlace *place, double x, double y,
                        double width, Flow *flow)
{
    char mark[16] = "\xe2\x80\xa2";
    *flow = (Flow){ .left = x,
                    .right = x + width,
                    .y = y,
                    .font = font_for(block),
                    .colour = colour_for(block),
                    .draw = flow->draw,
                    .field = flow->field,
                    .link = flow->link };
    if (block->kind == WR_GUIDE_CODE) {
        if (flow->draw) wr_gui_draw_fill(x, y, width, place->height, GROUND, 0);
        flow->left += wr_gui_px(10);
        flow->right -= wr_gui_px(10);
        if (block->command) set_run(flow, block);
        return set_code(flow, wr_guide_words(block, 0));
    }
    if (block->kind == WR_GUIDE_ITEM) {
        if (block->level > 0) snprintf(mark, sizeof mark, "%d.", block->level);
        double room = wr_gui_text_width(WR_FONT_TEXT, mark) + wr_gui_px(8);
        double gap = rint((line_height(WR_FONT_TEXT) - wr_gui_line_height(WR_FONT_TEXT)) / 2);
        if (flow->draw) wr_gui_draw_text(x, y + gap, WR_FONT_TEXT, WR_COLOUR_LABEL, mark);
        flow->left += fmax(room, wr_gui_px(INDENT));
    }
    if (block->kind != WR_GUIDE_ROW) return set_text(flow, &block->cells.data[0]);
    double tall = 0, pad = wr_gui_px(3);
    for (int k = 0; k < block->cells.count; k++) {
        flow->y = y + pad;
        flow->left = x;
        flow->right = x + place->column[k] + 1;
        tall = fmax(tall, set_text(flow, &block->cells.data[k]) + 2 * pad);
        x += place->column[k] + wr_gui_px(CELL_GAP);
    }
    return tall + 1;
}

/* The picture's own size, limited to the width. */
static double picture_size(const WrGuideBlock *block, double width, WrGuidePictures *pictures,
                           double *wide, SDL_Texture **texture)
{
    int w, h;
    *texture = guide_picture(pictures, block->cells.data[0].spans.data[0].link, &w, &h);
    *wide = 0;
    if (!*texture) return wr_gui_px(24);
    double scale = fmin(fmax(1.0, floor(wr_gui_scale())), width / w);
    *wide = floor(w * scale);
    return floor(h * scale);
}

void wr_guide_layout_fini(WrGuideLayout *layout)
{
    wr_array_free(&layout->places);
    *layout = (WrGuideLayout){ 0 };
}

bool wr_guide_layout(WrGuideLayout *layout, const WrGuidePage *page, double width,
                     WrGuidePictures *pictures)
{
    int made = guide_pictures_made(pictures);
    double room = width - 2 * wr_gui_px(MARGIN), y = 0, wide;
    if (layout->page == page && layout->width == width && layout->scale == wr_gui_scale() &&
        layout->pictures == made)
        return false;
    layout->page = page;
    layout->width = width;
    layout->scale = wr_gui_scale();
    layout->pictures = made;
    layout->places.count = 0;
    wr_array_reserve(&layout->places, page->blocks.count);
    layout->places.count = page->blocks.count;
    for (int i = 0; i < page->blocks.count; i++) {
        const WrGuideBlock *block = &page->blocks.data[i];
        WrGuidePlace *place = &layout->places.data[i];
        SDL_Texture *texture;
        Flow flow = { 0 };
        if (block->kind == WR_GUIDE_ROW && !block->joined) place_columns(layout, i, room);
        y += wr_gui_px(space_above(block, i == 0));
        place->y = y;
        place->height = block->kind == WR_GUIDE_PICTURE
                            ? picture_size(block, room, pictures, &wide, &texture)
                            : set_block(block, place, 0, 0, room, &flow);
        y += place->height;
        if (block->kind == WR_GUIDE_HEADING) y += wr_gui_px(block->level == 1 ? 4 : 0);
    }
    layout->height = y + wr_gui_px(MARGIN);
    return true;
}

/* ---- drawing ---- */

static void draw_picture(const WrGuideBlock *block, double x, double y, double room,
                         WrGuidePictures *pictures)
{
    double wide;
    SDL_Texture *texture;
    double tall = picture_size(block, room, pictures, &wide, &texture);
    if (texture) wr_gui_page_image(texture, x, y, wide, tall);
    else wr_gui_draw_text(x, y, WR_FONT_SMALL, WR_COLOUR_LABEL, wr_guide_words(block, 0));
}

const char *wr_guide_draw(const WrGuideLayout *layout, const WrGuiPage *field, int marked,
                          WrGuidePictures *pictures)
{
    double x = field->x + wr_gui_px(MARGIN), room = layout->width - 2 * wr_gui_px(MARGIN);
    Flow flow = { .draw = true, .field = field };
    for (int i = 0; i < layout->places.count; i++) {
        const WrGuideBlock *block = &layout->page->blocks.data[i];
        const WrGuidePlace *place = &layout->places.data[i];
        double y = field->y + place->y;
        if (y + place->height < field->top || y > field->bottom) continue;
        if (i == marked)
            wr_gui_draw_fill(x - wr_gui_px(6), y - 2, room + wr_gui_px(12), place->height + 4,
                             MARKED, 3);
        if (block->kind == WR_GUIDE_PICTURE) {
            draw_picture(block, x, y, room, pictures);
            continue;
        }
        set_block(block, place, x, y, room, &flow);
        if (block->kind == WR_GUIDE_ROW) /* a line below each row */
            wr_gui_draw_fill(x, y + place->height - 1, room, 1, WR_COLOUR_EDGE, 0);
        if (block->kind == WR_GUIDE_HEADING && block->level == 1)
            wr_gui_draw_fill(x, y + place->height + 1, room, 1, WR_COLOUR_ACCENT, 0);
    }
    return flow.link;
}
