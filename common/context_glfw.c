/* OpenGL in a window. */
#include "context.h"

#include <stdio.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static void destroy(void *handle) {
    glfwDestroyWindow(handle);
    glfwTerminate();
}

Context *context_window(int width, int height, const char *title, const char **reason) {
    static const ContextKind glfw = {"GLFW", glfwGetProcAddress, destroy};
    GLFWwindow *window = NULL;
    if (glfwInit()) {
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE); /* macOS gives 3.3 only so */
        window = glfwCreateWindow(width, height, title, NULL, NULL);
    }
    if (!window) {
        static char message[256]; /* GLFW's own text lives only until its next call */
        const char *why = NULL;
        glfwGetError(&why);
        snprintf(message, sizeof message, "%s", why ? why : "no display");
        glfwTerminate();
        *reason = message;
        return NULL;
    }
    glfwMakeContextCurrent(window);
    return context_adopt(&glfw, window, true);
}
