#include "globe.h"
#define T(n, f, w) {.name = n, .what = w, .vertex = "everywhere.vert", .fragment = f}
static const Lesson lesson = {
    .name = "18-light-field", .title = "light-field textures",
    .scenes = {{"composed", "seven solids", .techniques = {T("trilinear", "trilinear.frag", "plain"), T("frames", "frames.frag", "x"),
       T("nearest", "nearest.frag", "x"),T("shared", "shared.frag", "x"),T("paper", "paper.frag", "x"),T("paper-fast", "paper-fast.frag", "x")},
      .views = {{"front", {.eye = {0,0,9}, .up = {0,1,0}, .fov_y_degrees = 50, .near=.1, .far=30}},
                {"aside", {.eye = {6,3,6}, .up = {0,1,0}, .fov_y_degrees = 50, .near=.1, .far=30}},
                {"pole", {.eye = {0,9,0}, .up = {0,0,-1}, .fov_y_degrees = 50, .near=.1, .far=30}}},
      .load = globe_load, .unload = globe_unload, .draw = globe_draw, .truth = globe_truth}}};
int main(int argc, char **argv) { return lesson_run(&lesson, argc, argv); }
