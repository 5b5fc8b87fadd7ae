# SPDX-License-Identifier: MIT
# Doxygen's input filter for headers. Does not change the number of lines.
#
# Turns the comment below the licence into the documentation of the file, adds everything in the file to the group
# `scarp` if common_headers.txt lists it, or else to that of its folder (scarp/march/height/x.h: scarp_march_height), and
# keeps indented lines of comments, such as figures, verbatim.

BEGIN {
  while ((getline header < "doc/api/common_headers.txt") > 0) common[header] = 1
}

function flush_line(suffix) {
  if (have) print held suffix
  have = 0
}

function emit(line) {
  flush_line("")
  held = line
  have = 1
}

# `text`: the rest of a documentation line after its slashes.
function document(text) {
  if (text ~ /^  +[^ ]/ && text !~ /^  +- /) {
    if (!verbatim) {
      flush_line(" @verbatim")
      verbatim = 1
    }
    emit("///" text)
  } else if (verbatim && text ~ /[^ ]/) {
    verbatim = 0
    emit("/// @endverbatim" text)
  } else {
    emit("///" text)
  }
}

function end_comment() {
  if (verbatim) flush_line(" @endverbatim")
  verbatim = 0
}

FNR == 1 {
  path = FILENAME
  sub(/^(.*\/)?scarp\//, "scarp/", path)
  if (path in common) path = "scarp/"
  sub(/\/[^\/]*$/, "", path)
  gsub(/\//, "_", path)
  emit("/// @file")
  head = 1
  next
}

head && /^\/\// {
  document(substr($0, 3))
  next
}

{ head = 0 }

/^ *\/\/\/($|[^<])/ {
  document(substr($0, index($0, "///") + 3))
  next
}

{ end_comment() }

opened && !closed_brace {
  closed_brace = 1
  if ($0 == "") {
    emit("@{ */")
    next
  }
  held = held " @{ */"
}

!opened && (/^namespace scarp/ || /^SCARP_GLSL_BEGIN/) {
  opened = 1
  last = $0 ~ /^namespace/ ? "^}  // namespace scarp" : "^SCARP_GLSL_END"
  emit($0 " /** @addtogroup " path)
  next
}

opened && last != "" && $0 ~ last {
  emit("/** @} */ " $0)
  last = ""
  next
}

{ emit($0) }

END { flush_line("") }
