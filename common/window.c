#define _GNU_SOURCE /* open_memstream, vasprintf */
#include "window.h"

#include "command.h"
#include "context.h"
#include "fail.h"
#include "screen.h"
#include "show.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static const char help_text[] = "drag     turns the camera about its target\n"
                                "right    (drag) moves it aside\n"
                                "scroll   comes nearer\n"
                                "1..9     the technique; Tab: the next one\n"
                                "[ ]      the technique's knob\n"
                                "V        the next view\n"
                                "N        the next scene\n"
                                "space    what moves by itself goes on, or stops\n"
                                "S        technique | truth, divided by the mouse\n"
                                "D        the error as a heat map (FLIP)\n"
                                "F        full screen\n"
                                "+ -      the text's size, down to none\n"
                                "P        saves the picture in build/pictures/\n"
                                "C        prints the command line of this picture\n"
                                "H        this\n"
                                "Esc Q    closes";

static const double NOTICE = 4.0; /* seconds that a message stays */

enum { CORNER, MESSAGE, HELP, LEFT, RIGHT }; /* the boxes of text */

typedef struct {
    GLFWwindow *glfw;
    Show show;
    Screen screen;
    bool shown; /* the screen is up to date */
    bool divided, heated, helped;
    int text_step;
    char *note; /* what was done, or NULL, */
    double note_end;
    Vec2 mouse;   /* screen units from the upper left */
    int place[4]; /* x, y, width and height before full screen */
} Window;

static Vec2 window_size(const Window *w) { /* screen units, at least one */
    int width, height;
    glfwGetWindowSize(w->glfw, &width, &height);
    return v2(width > 1 ? width : 1, height > 1 ? height : 1);
}

/* ---- The screen ---- */

static int text_size(const Window *w) { /* pixels; what is below 8 is not shown */
    float scale = 1.0f, other;
    glfwGetWindowContentScale(w->glfw, &scale, &other);
    return (int)lround(15.0 * scale * pow(1.15, w->text_step));
}

static char *corner_text(const Window *w) {
    char *result;
    size_t size;
    FILE *out = open_memstream(&result, &size);
    const Show *show = &w->show;
    const Technique *technique = show_chosen(show);
    const Refined *known = &show->refined;
    Cost cost = show_cost(show);
    fprintf(out, "%s\nscene %s, view %s%s\n", show->lesson->title, show->stage.scene->name, show->start->name,
            show->moved ? " (moved)" : "");
    fprintf(out, "%d %s: %s\n", show->technique + 1, technique->name, technique->what);
    if (technique->knob.name) fprintf(out, "[ ] %s %g\n", technique->knob.name, show->knobs[show->technique]);
    if (show->frames)
        fprintf(out, "%.2f ms a frame", 1e-6 * cost.draw_ns);
    else
        fprintf(out, "not drawn");
    if (technique->prepare) fprintf(out, ", after %.2f ms in C", 1e-6 * cost.prepare_ns);
    if (known->reason[0])
        fprintf(out, "\nno error: %s", known->reason);
    else if (show->moving)
        fprintf(out, "\nit moves; space stops it");
    else if (known->judged)
        fprintf(out, "\nrmse %.4f, FLIP %.4f (truth: %d rays a pixel)", known->difference.rmse,
                known->difference.flip, known->judged);
    else
        fprintf(out, "\nrmse, FLIP: once the camera rests");
    if (w->heated) fprintf(out, "\nheat map: FLIP, from black (0) to white (1)");
    if (show->stage.scene->move && !show->moving) fprintf(out, "\nspace lets it move");
    fprintf(out, "\nH help");
    fclose(out);
    return result;
}

static double divider_of(const Window *w) { /* pixels; beyond the window where there is none */
    if (!w->divided) return w->show.width + 10.0;
    return round(clamp(w->mouse.x / window_size(w).x, 0.0, 1.0) * w->show.width);
}

static void draw_pictures(Window *w) {
    const Show *show = &w->show;
    screen_pictures(&w->screen, w->heated && show->heat.id ? &show->heat : show->picture,
                    show->exact.id ? &show->exact : &show->nothing, divider_of(w), show->width, show->height);
}

static void draw_text(Window *w) {
    Screen *screen = &w->screen;
    const Show *show = &w->show;
    const Vec2 lower_left = v2(0, 0), lower_right = v2(1, 0), upper_left = v2(0, 1), middle = v2(0.5, 0.5);
    double gap = 8.0, divider = divider_of(w), bottom = gap;
    int size = text_size(w);
    if (w->divided) {
        char *truth = show->refined.rays ? text("truth, %d rays a pixel", show->refined.rays) : text("truth");
        const char *name = w->heated ? "error" : show_chosen(show)->name;
        bottom += gap + screen_text(screen, LEFT, name, size, v2(divider - gap, gap), lower_right, false);
        screen_text(screen, RIGHT, truth, size, v2(divider + gap, gap), lower_left, false);
        free(truth);
    }
    if (w->helped) {
        screen_text(screen, HELP, help_text, size, v2(show->width / 2.0, show->height / 2.0), middle, false);
    } else {
        char *corner = corner_text(w);
        screen_text(screen, CORNER, corner, size, v2(gap, show->height - gap), upper_left, false);
        free(corner);
    }
    const char *message = w->note ? w->note : show->log ? show->log : "";
    screen_text(screen, MESSAGE, message, size, v2(gap, bottom), lower_left, !w->note);
}

/* Shows a line for a while; standard error has it too. */
__attribute__((format(printf, 2, 3))) static void say(Window *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    free(w->note);
    if (vasprintf(&w->note, format, arguments) < 0) fail("out of memory");
    va_end(arguments);
    fprintf(stderr, "%s\n", w->note);
    w->note_end = glfwGetTime() + NOTICE;
    w->shown = false;
}

/* ---- Keys and the mouse ---- */

/* What the window shows, without its text: the bytes of the framebuffer itself. */
static void save(Window *w) {
    show_draw(&w->show);
    draw_pictures(w);
    Image image = screen_read(&w->screen);
    Frame frame = show_frame(&w->show);
    char *name = picture_name(&frame), *build = project_path("build");
    const char *what = w->divided ? "-divided" : w->heated ? "-error" : "";
    char *folder = text("%s/pictures", build), *path = text("%s/%s%s.png", folder, name, what);
    mkdir(build, 0777); /* what fails here fails below, with a reason */
    mkdir(folder, 0777);
    const char *reason = image_write(&image, path);
    if (reason)
        say(w, "%s: %s", path, reason);
    else
        say(w, "saved build/pictures/%s%s.png", name, what);
    image_destroy(&image);
    free(name), free(build), free(folder), free(path);
}

static void print_command(Window *w) {
    Frame frame = show_frame(&w->show);
    command_print(&frame, w->show.moved ? &frame.camera : NULL, w->show.options);
}

/* The monitor that the window's middle lies on. */
static GLFWmonitor *monitor_of(const Window *w) {
    int count;
    GLFWmonitor **monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; i++) {
        int x, y;
        const GLFWvidmode *mode = glfwGetVideoMode(monitors[i]);
        glfwGetMonitorPos(monitors[i], &x, &y);
        x = w->place[0] + w->place[2] / 2 - x;
        y = w->place[1] + w->place[3] / 2 - y;
        if (mode && x >= 0 && x < mode->width && y >= 0 && y < mode->height) return monitors[i];
    }
    return glfwGetPrimaryMonitor();
}

static void full_screen(Window *w) {
    int *place = w->place;
    if (glfwGetWindowMonitor(w->glfw)) {
        glfwSetWindowMonitor(w->glfw, NULL, place[0], place[1], place[2], place[3], 0);
        return;
    }
    glfwGetWindowPos(w->glfw, &place[0], &place[1]);
    glfwGetWindowSize(w->glfw, &place[2], &place[3]);
    GLFWmonitor *monitor = monitor_of(w);
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;
    if (mode) glfwSetWindowMonitor(w->glfw, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

static void knob_down(Window *w) { show_knob(&w->show, false); }
static void knob_up(Window *w) { show_knob(&w->show, true); }
static void next_view(Window *w) { show_next_view(&w->show); }
static void next_scene(Window *w) { show_next_scene(&w->show); }
static void motion(Window *w) { show_motion(&w->show); }
static void divide(Window *w) { w->show.eager = w->divided = !w->divided; }
static void heat(Window *w) { w->heated = !w->heated; }
static void larger(Window *w) { w->text_step += w->text_step < 12; }
static void smaller(Window *w) { w->text_step -= text_size(w) >= 8; }
static void help(Window *w) { w->helped = !w->helped; }
static void close_window(Window *w) { glfwSetWindowShouldClose(w->glfw, true); }

/* Keys that make a letter come as that letter, wherever the keyboard has it. */
static void on_letter(GLFWwindow *glfw, unsigned letter) {
    static const struct {
        char letter;
        void (*act)(Window *);
    } keys[] = {{'[', knob_down}, {']', knob_up}, {'v', next_view},    {'n', next_scene},    {'s', divide},
                {'d', heat},      {'h', help},    {'f', full_screen},  {'+', larger},        {'=', larger},
                {'-', smaller},   {'p', save},    {'q', close_window}, {'c', print_command}, {' ', motion}};
    Window *w = glfwGetWindowUserPointer(glfw);
    w->shown = false;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (letter < 128 && tolower((int)letter) == keys[i].letter) keys[i].act(w);
}

static void on_key(GLFWwindow *glfw, int key, int code, int action, int modifiers) {
    Window *w = glfwGetWindowUserPointer(glfw);
    (void)code;
    if (action == GLFW_RELEASE) return;
    Show *show = &w->show;
    int count = technique_count(show->stage.scene), digit = -1;
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) digit = key - GLFW_KEY_1;
    if (key >= GLFW_KEY_KP_1 && key <= GLFW_KEY_KP_9) digit = key - GLFW_KEY_KP_1;
    if (digit >= 0 && digit < count) show_technique(show, digit);
    if (key == GLFW_KEY_TAB)
        show_technique(show, (show->technique + (modifiers & GLFW_MOD_SHIFT ? count - 1 : 1)) % count);
    if (key == GLFW_KEY_ESCAPE) close_window(w);
}

static void on_mouse(GLFWwindow *glfw, double x, double y) {
    Window *w = glfwGetWindowUserPointer(glfw);
    if (glfwGetMouseButton(glfw, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        double turn = PI / window_size(w).y; /* half a turn from top to bottom; the scene follows the mouse */
        camera_orbit(&w->show.camera, turn * (w->mouse.x - x), turn * (y - w->mouse.y));
        show_moved(&w->show);
    }
    if (glfwGetMouseButton(glfw, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS) {
        double pixel = 1.0 / window_size(w).y; /* of the picture's height */
        camera_pan(&w->show.camera, (w->mouse.x - x) * pixel, (y - w->mouse.y) * pixel);
        show_moved(&w->show);
    }
    w->mouse = v2(x, y);
    if (w->divided) w->shown = false;
}

static void on_scroll(GLFWwindow *glfw, double x, double y) {
    Window *w = glfwGetWindowUserPointer(glfw);
    (void)x;
    camera_nearer(&w->show.camera, pow(1.1, y));
    show_moved(&w->show);
}

static void on_exposure(GLFWwindow *glfw) { ((Window *)glfwGetWindowUserPointer(glfw))->shown = false; }

static void listen(Window *w) {
    glfwSetWindowUserPointer(w->glfw, w);
    glfwSetCharCallback(w->glfw, on_letter);
    glfwSetKeyCallback(w->glfw, on_key);
    glfwSetCursorPosCallback(w->glfw, on_mouse);
    glfwSetScrollCallback(w->glfw, on_scroll);
    glfwSetWindowRefreshCallback(w->glfw, on_exposure);
    glfwGetCursorPos(w->glfw, &w->mouse.x, &w->mouse.y);
}

/* ---- All of it ---- */

static void watch_note(Window *w) {
    if (!w->note || glfwGetTime() < w->note_end) return;
    free(w->note);
    w->note = NULL;
    w->shown = false;
}

/* Brings the screen up to date. Returns the seconds until there may be more to do if nothing happens before.
 */
static double turn(Window *w) {
    int width, height;
    glfwGetFramebufferSize(w->glfw, &width, &height);
    if (width < 1 || height < 1) return 0.25; /* it is an icon now */
    show_size(&w->show, width, height);
    double pause = show_update(&w->show);
    watch_note(w);
    if (w->shown && !w->show.changed) return pause;
    draw_pictures(w);
    draw_text(w);
    glfwSwapBuffers(w->glfw);
    w->shown = true;
    w->show.changed = false;
    return pause;
}

void window_run(const Lesson *lesson, const Options *options, const Choice *choice) {
    const char *reason;
    char *title = text("%s: %s", lesson->name, lesson->title), *common = project_path("common");
    Context *context = context_window(choice->width, choice->height, title, &reason);
    if (!context) fail("no window (%s); --render DIR needs no display", reason);
    Window *w = allocate(1, sizeof *w);
    w->glfw = context_handle(context);
    w->screen = screen_open(common);
    show_open(&w->show, lesson, options, choice, glfwPostEmptyEvent);
    listen(w);
    while (!glfwWindowShouldClose(w->glfw)) {
        double pause = turn(w);
        if (pause > 0.0)
            glfwWaitEventsTimeout(pause);
        else
            glfwPollEvents();
    }
    show_close(&w->show);
    screen_close(&w->screen);
    context_destroy(context);
    free(w->note), free(w), free(title), free(common);
}
