// SPDX-License-Identifier: MIT
// Vulkan calls that lose the window's surface or the device, for window_faults_test: loaded before the Vulkan loader
// (LD_PRELOAD), with LOSE=PLACE:WHAT:FIRST:COUNT. PLACE: acquire or present. WHAT: out-of-date, suboptimal, surface or
// device. COUNT calls, from call FIRST on, have that result. A lost surface is lost for all calls until it is
// destroyed, and a lost device is lost for ever.
#include <dlfcn.h>
#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

template <class Call>
Call original(const char* name) {
  return reinterpret_cast<Call>(dlsym(RTLD_NEXT, name));
}

struct Plan {
  std::string place, what;
  int first = 0, count = 0;
};

Plan read_plan() {
  const char* const text = std::getenv("LOSE");
  char place[16] = "", what[16] = "";
  Plan plan;
  if (!text || std::sscanf(text, "%15[^:]:%15[^:]:%d:%d", place, what, &plan.first, &plan.count) != 4) std::abort();
  plan.place = place, plan.what = what;
  return plan;
}

bool surface_lost = false, device_lost = false;

// Result of a call at `place`.
VkResult meet(const char* place) {
  static const Plan plan = read_plan();
  static int calls = 0;
  if (device_lost) return VK_ERROR_DEVICE_LOST;
  if (surface_lost) return VK_ERROR_SURFACE_LOST_KHR;
  if (plan.place != place) return VK_SUCCESS;
  ++calls;
  if (calls < plan.first || calls >= plan.first + plan.count) return VK_SUCCESS;
  std::fprintf(stderr, "lost: %s\n", plan.what.c_str());
  if (plan.what == "out-of-date") return VK_ERROR_OUT_OF_DATE_KHR;
  if (plan.what == "suboptimal") return VK_SUBOPTIMAL_KHR;
  if (plan.what == "surface") {
    surface_lost = true;
    return VK_ERROR_SURFACE_LOST_KHR;
  }
  device_lost = true;
  return VK_ERROR_DEVICE_LOST;
}

}  // namespace

extern "C" {

VkResult vkAcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout, VkSemaphore semaphore,
                               VkFence fence, uint32_t* index) {
  static const auto call = original<PFN_vkAcquireNextImageKHR>("vkAcquireNextImageKHR");
  const VkResult met = meet("acquire");
  if (met < 0) return met;
  const VkResult result = call(device, swapchain, timeout, semaphore, fence, index);
  return result == VK_SUCCESS ? met : result;
}

// The present itself still happens, as it may for these results: it waits for the semaphores.
VkResult vkQueuePresentKHR(VkQueue queue, const VkPresentInfoKHR* info) {
  static const auto call = original<PFN_vkQueuePresentKHR>("vkQueuePresentKHR");
  const VkResult result = call(queue, info), met = meet("present");
  return met == VK_SUCCESS ? result : met;
}

VkResult vkGetPhysicalDeviceSurfaceCapabilitiesKHR(VkPhysicalDevice device, VkSurfaceKHR surface,
                                                   VkSurfaceCapabilitiesKHR* can) {
  static const auto call =
      original<PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR>("vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  return surface_lost ? VK_ERROR_SURFACE_LOST_KHR : call(device, surface, can);
}

void vkDestroySurfaceKHR(VkInstance instance, VkSurfaceKHR surface, const VkAllocationCallbacks* callbacks) {
  static const auto call = original<PFN_vkDestroySurfaceKHR>("vkDestroySurfaceKHR");
  call(instance, surface, callbacks);
  if (surface_lost) std::fprintf(stderr, "lost: destroyed\n");
  surface_lost = false;
}

VkResult vkWaitForFences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout) {
  static const auto call = original<PFN_vkWaitForFences>("vkWaitForFences");
  return device_lost ? VK_ERROR_DEVICE_LOST : call(device, count, fences, all, timeout);
}

VkResult vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence) {
  static const auto call = original<PFN_vkQueueSubmit>("vkQueueSubmit");
  return device_lost ? VK_ERROR_DEVICE_LOST : call(queue, count, submits, fence);
}

VkResult vkDeviceWaitIdle(VkDevice device) {
  static const auto call = original<PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle");
  call(device);
  return device_lost ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

}  // extern "C"
