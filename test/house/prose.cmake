# Text for users and callers is plain English. This test finds patterns that native engineers do not write (`rules` below).
#   cmake -D ROOT=<checkout> [-D SCARP=<program>] -P prose.cmake
# It skips code blocks and `inline code`, and reads only the comments of code. Before it checks the checkout, it proves
# itself on planted text. To cover more text, add one line to one of these lists.
cmake_minimum_required(VERSION 3.25)

set(documents README.md CHANGELOG.md APICHANGES.md CONTRIBUTING.md bench/README.md doc/user/*.md doc/library/*.md doc/dev/*.md doc/dev/decisions/*.md .github/*.md
    .github/ISSUE_TEMPLATE/*.md)
# folders whose code is checked, subfolders included
set(code_folders scarp app bench python test examples)
set(code_files h cpp comp vert frag glsl gdshader shader)
# calls of the program whose output is checked; only of subcommands that every build has
set(help_calls "--help" "render --help all" "cast --help all" "composite --help all" "viewshed --help all" "shadow --help all"
    "los --help all" "profile --help all" "info --help all" "generate --help all" "replay --help all" "voxelise --help all"
    "section --help all" "marches --help" "marches" "marches --presets")

# PATTERN => remedy. < is the start of a sentence, > the end of a paragraph or a table cell, @ a word boundary.
set(rules
    "<Of [^>] => name the subject first"
    "<What [^?>]*[.]( |>) => name the subject first"
    "<So [^?>]*[.]( |>) => name the subject first"
    "<That is so@ => name the subject first"
    "<Who [^?>]*[.]( |>) => the caller, the user, a program that"
    ": who [^?>]*[.]( |>) => the caller, the user, a program that"
    "@([Tt]hose who|[Ww]hoever|[Oo]ne who)@ => callers, users, programs that"
    "@[Tt]old@ => reported, printed, returned"
    "@(note|message|line|header|page|help) tells?@ => reports, prints, shows"
    "@(is|are|was|were|be) (asked|said)@ => is queried, is printed"
    "@(is|are|was|were|be) looked at@ => is examined"
    "@(is|are|was|were|be) no [a-z] => is not a"
    "@[Tt]here (run|runs|stand|stands)@ => available:"
    "@that there (is|are)([.,:;)]|>) => available"
    "@(go|goes|went) with@ => applies to, is valid for"
    "@([Ww]here from|[Ww]hence)@ => from which"
    "@none but [a-z] => only, except"
    "[a-z] but for [a-z] => except for"
    "@of (yours|mine|theirs|ours|one's own|the caller's)@ => your, caller-owned"
    "@to be had@ => available"
    "@anew@ => again, re-"
    "@mend(s|ed)?@ => fix"
    "@(leave it out|(if|as) (you|one) likes?)@ => is only valid for, optional")

# Correct English that a rule would find.
set(idioms "[Oo]f course" "[Ss]o far" "told apart" "(is|are|was|were|be) said to be" "(is|are|was|were|be) asked (to|for|whether)"
    "[Tt]here (is|are|was|were|will be|would be|can be|may be|must be|should be) no"
    "(is|are|was|were|be) no (longer|more|less|fewer|better|worse|matter|doubt|greater|larger|smaller|higher|lower|slower|faster|farther|nearer|closer|wider|shorter)")

string(ASCII 31 mark)

# prepare(TEXT RESULT): one line; paragraphs, list items and table cells are separated by the mark.
function(prepare text result)
  # Semicolons, brackets and backslashes are list syntax to CMake.
  string(REPLACE ";" "," text "\n${text}")
  string(REPLACE "[" "(" text "${text}")
  string(REPLACE "]" ")" text "${text}")
  string(REPLACE "\\" "/" text "${text}")
  string(REGEX REPLACE "\n[ ]*```[^`]*```" "\n\n" text "${text}")
  string(REGEX REPLACE "`[^`]*`" "CODE" text "${text}")
  string(REGEX REPLACE "\n[ \t]*([-*] |[0-9]+[.] |#+ |[|])" "${mark}" text "${text}")
  string(REGEX REPLACE "\n[ \t]*\n" "${mark}" text "${text}")
  string(REGEX REPLACE "[ \t\n]+" " " text "${text}")
  string(REGEX REPLACE " ?([|]|[*][*]|${mark})[ ${mark}]*" "${mark}" text "${mark}${text}${mark}")
  foreach(idiom IN LISTS idioms)
    string(REGEX REPLACE "${idiom}" "IDIOM " text "${text}")
  endforeach()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# check(NAME TEXT LIST): appends one line per breach to LIST.
function(check name text out)
  prepare("${text}" text)
  set(found ${${out}})
  foreach(rule IN LISTS rules)
    string(REGEX MATCH "^(.*) => (.*)$" ignored "${rule}")
    set(pattern "${CMAKE_MATCH_1}")
    set(remedy "${CMAKE_MATCH_2}")
    string(REPLACE "<" "(${mark}|[.!?:] )[(]?" pattern "${pattern}")
    string(REPLACE ">" "${mark}" pattern "${pattern}")
    string(REPLACE "@" "[^A-Za-z0-9_-]" pattern "${pattern}")
    string(REGEX MATCHALL "${pattern}" hits "${text}")
    set(rest "${text}")
    foreach(hit IN LISTS hits)
      string(FIND "${rest}" "${hit}" place)
      string(LENGTH "${hit}" length)
      math(EXPR begin "${place} - 30")
      if(begin LESS 0)
        set(begin 0)
      endif()
      math(EXPR length "${place} - ${begin} + ${length} + 30")
      string(SUBSTRING "${rest}" ${begin} ${length} excerpt)
      string(REPLACE "${mark}" " " excerpt "${excerpt}")
      list(APPEND found "${name}: '...${excerpt}...': ${remedy}")
      math(EXPR place "${place} + 1")
      string(SUBSTRING "${rest}" ${place} -1 rest)
    endforeach()
  endforeach()
  set(${out} "${found}" PARENT_SCOPE)
endfunction()

# comments_of(TEXT RESULT): the comments of code; the code in between ends a paragraph.
function(comments_of text result)
  string(REPLACE ";" "," text "${text}")
  string(REPLACE "[" "(" text "${text}")
  string(REPLACE "]" ")" text "${text}")
  string(REPLACE "\\" "/" text "${text}")
  string(REPLACE "\n" ";" lines "${text}")
  set(comments "")
  foreach(line IN LISTS lines)
    if(line MATCHES "^ *//[/<]* ?(.*)$")
      string(APPEND comments "${CMAKE_MATCH_1}\n")
    elseif(line MATCHES " //[/<]* ?(.*)$")
      string(APPEND comments "\n${CMAKE_MATCH_1}\n")
    else()
      string(APPEND comments "\n")
    endif()
  endforeach()
  set(${result} "${comments}" PARENT_SCOPE)
endfunction()

function(prove_the_check)
  set(planted
      "Of two hits the first counts." "It works. Of the rest nothing is kept." "What is kept is the cell." "So it ends." "That is so here."
      "Who asks waits." "Batches are sorted: who calls waits." "Good for those who wait." "Misses are told as hits."
      "A note tells the unit." "The field is asked twice." "Cells are looked at once." "A touch is no hit." "There run two."
      "It takes the options that there are." "The option goes with terrain." "Where from: here." "It reads none but rasters."
      "It is right but for rounding." "Memory of yours." "No answer is to be had." "It is built anew." "This is mended." "Give a name, if you like.")
  set(clean
      "Of course the person who reads `what is told` is no longer lost, and there is no\nhit. Who is it for? So far, two are told apart."
      "It tells the compiler to inline all but one function, but for others it does not. The user is asked to wait. What is it? It goes without saying."
      "# What it does\n\n# Who it is for\n\n```\nOf what is told\n```\n\n| is said to be | fast |\n- a list of items\n1. without faults")
  set(count 0)
  foreach(text IN LISTS planted)
    set(breaches "")
    check(proof "${text}" breaches)
    list(LENGTH breaches count)
    if(NOT count EQUAL 1)
      message(FATAL_ERROR "the check is broken: in '${text}' it found ${count} breaches: ${breaches}")
    endif()
  endforeach()
  comments_of("/// Of two\nint who(); // told\nint told = 1;\nint a; ///< It goes\n ///< with b.\n" comments)
  set(breaches "")
  check(proof "${comments}" breaches)
  list(LENGTH breaches count)
  if(NOT count EQUAL 3)
    message(FATAL_ERROR "the check is broken: 3 breaches planted in comments, found ${breaches}")
  endif()
  set(breaches "")
  foreach(text IN LISTS clean)
    check(proof "${text}" breaches)
  endforeach()
  if(breaches)
    message(FATAL_ERROR "the check is broken: it finds fault with good English: ${breaches}")
  endif()
endfunction()

prove_the_check()
set(breaches "")
set(files "")
foreach(pattern IN LISTS documents)
  file(GLOB matching RELATIVE ${ROOT} ${ROOT}/${pattern})
  if(NOT matching)
    message(FATAL_ERROR "no document matches '${pattern}'")
  endif()
  list(APPEND files ${matching})
endforeach()
foreach(folder IN LISTS code_folders)
  list(TRANSFORM code_files PREPEND "${ROOT}/${folder}/*." OUTPUT_VARIABLE patterns)
  file(GLOB_RECURSE matching RELATIVE ${ROOT} ${patterns})
  if(NOT matching)
    message(FATAL_ERROR "no code in '${folder}'")
  endif()
  list(APPEND files ${matching})
endforeach()
list(JOIN code_files "|" code_files)
foreach(file IN LISTS files)
  file(READ ${ROOT}/${file} text)
  if(file MATCHES "[.](${code_files})$")
    comments_of("${text}" text)
  endif()
  check(${file} "${text}" breaches)
endforeach()
if(SCARP)
  foreach(call IN LISTS help_calls)
    separate_arguments(arguments UNIX_COMMAND "${call}")
    execute_process(COMMAND ${SCARP} ${arguments} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
    check("scarp ${call}" "${text}" breaches)
  endforeach()
endif()
if(breaches)
  list(LENGTH breaches count)
  list(JOIN breaches "\n  " text)
  message(FATAL_ERROR "${count} phrases that a native engineer would not write:\n  ${text}")
endif()
