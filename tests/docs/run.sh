#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Holds what the pages say: tests/docs/run.sh [CHECK...], all without names. Prints what is wrong, a
# line each, and the count; exit status 1 if anything is. SIMULATOR names the executable (default:
# that of the release build), OCA_SOURCE the source tree.
set -uo pipefail
root=${OCA_SOURCE:-$(cd "$(dirname "$0")/../.." && pwd)}
simulator=${SIMULATOR:-$root/build/release/tools/simulator}
[ -x "$simulator" ] || { echo "no simulator at $simulator; build it: tools/setup.sh release simulator" >&2; exit 2; }
simulator=$(realpath "$simulator")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root" || exit 2
problems=0
problem() { echo "$*"; problems=$((problems + 1)); }

files() { # NAME... -> the tree's own files of such names
  local names=() name
  for name; do names+=(-o -name "$name"); done
  find . \( -name .git -o -name build -o -name node_modules \) -prune -o -type f \( "${names[@]:1}" \) -print |
    sed 's|^\./||' | sort
}
pages() { files '*.md'; }
headings() { # PAGE -> anchors, as GitHub names them
  awk '/^```/ { code = !code } !code && /^#/' "$1" |
    sed -E 's/^#+ +//; s/`//g; s/\[([^]]*)\]\([^)]*\)/\1/g' | tr '[:upper:]' '[:lower:]' |
    sed -E "s/[^a-z0-9 _-]//g; s/ /-/g"
}
links() { # PAGE -> targets of links and pictures, outside code
  awk '/^ *```/ { code = !code } !code' "$1" | sed -E 's/`[^`]*`//g' | grep -oE '\]\([^) ]+\)' | sed -E 's/^\]\(//; s/\)$//'
}
blocks() { # PAGE LANGUAGE -> the fenced blocks of that language; none: what commands print
  awk -v open="\`\`\`$2" '/^```/ { code = !code; on = code && $0 == open; next } on' "$1"
}

check_readme_is_short() {
  local lines
  lines=$(wc -l < README.md)
  [ "$lines" -le 150 ] || problem "README.md: $lines lines; expected at most 150"
}

check_links() {
  local page target file anchor
  while read -r page; do
    while read -r target; do
      case $target in
        http://* | https://* | mailto:*) continue ;;
      esac
      file=${target%%#*} anchor=
      [[ $target == *#* ]] && anchor=${target#*#}
      if [ -z "$file" ]; then file=$page; else file=$(dirname "$page")/$file; fi
      if [ ! -e "$file" ]; then
        problem "$page: link to $target, which is not there"
      elif [ -n "$anchor" ] && ! headings "$file" | grep -qxF -- "$anchor"; then
        problem "$page: link to $target, a heading that is not there"
      fi
    done < <(links "$page")
  done < <(pages)
}

check_every_page_and_picture_is_linked() {
  local file
  for page in $(pages); do
    links "$page" | sed 's/#.*//' | while read -r target; do
      [ -n "$target" ] && realpath -m --relative-to=. "$(dirname "$page")/$target"
    done
  done | sort -u > "$work/linked"
  for file in $(find docs -name '*.md' -o -name '*.svg' -o -name '*.png'); do
    [ "$file" = docs/index.md ] || grep -qxF "$file" "$work/linked" || problem "$file: no page links to it"
  done
}

# A page that a source line cites is in the tree, by its path, beside that file or, for links that a
# program writes, from the reference; and has the section that is named.
check_cited_pages() {
  local where cited section
  files '*.h' '*.cc' '*.cmake' CMakeLists.txt '*.yaml' '*.yaml.in' '*.sh' '*.ts' '*.mjs' '*.urdf' '*.srdf' | xargs grep -noE '[$A-Za-z0-9_./-]+\.md\b' |
    while IFS=: read -r where line cited; do
      [[ $where == tests/docs/* || $cited == *\$* || $cited == //* || $cited == .md ]] && continue
      [ -e "${cited#/}" ] || [ -e "$(dirname "$where")/$cited" ] || [ -e "docs/reference/$cited" ] ||
        echo "$where:$line: cites $cited, which is not there"
    done > "$work/cited"
  files '*.h' '*.cc' | xargs grep -noE 'docs/theory\.md, [A-Z][A-Za-z ]+' | while IFS=: read -r where line cited; do
    section=$(sed -E 's/^docs.theory.md, //; s/ +$//' <<< "$cited")
    grep -qxF "## $section" docs/theory.md || echo "$where:$line: cites section '$section', which docs/theory.md does not have"
  done >> "$work/cited"
  while read -r line; do problem "$line"; done < "$work/cited"
}

check_named_files_are_there() {
  local page file
  for page in $(pages); do
    [[ $page == CHANGELOG.md ]] && continue  # it names what was
    for file in $(grep -oE '\b(framework|systems|models|diagrams|tools|tests|cmake|docs)/[A-Za-z0-9_/.-]+\.(h|cc|sh|yaml|md|urdf|csv)\b' "$page" | sort -u); do
      [[ -e $file || $file == *NAME* ]] || problem "$page: names $file, which is not there"
    done
  done
}

check_smallest_diagram_runs() {
  blocks README.md yaml > "$work/first.yaml"
  grep -v '^# yaml-language-server' diagrams/first.yaml | diff -u - "$work/first.yaml" > "$work/diff" ||
    problem "README.md: its diagram is not diagrams/first.yaml: $(cat "$work/diff")"
  [ "$(wc -l < "$work/first.yaml")" -le 15 ] || problem "README.md: its diagram has more than 15 lines"
  "$simulator" run diagrams/first.yaml --no-progress > "$work/out" 2>&1 || problem "diagrams/first.yaml: $(cat "$work/out")"
  local page
  for page in README.md docs/tutorial/first_hour.md; do  # what it prints, but for how long it took
    blocks "$page" "" | sed -n '/^first: /,/^  time  /p' | grep -v '^  time  ' > "$work/shown"
    grep -v '^  time  ' "$work/out" | diff -u "$work/shown" - > "$work/diff" ||
      problem "$page: shows what diagrams/first.yaml does not print: $(cat "$work/diff")"
  done
}

check_generated_pages() {
  local page
  SIMULATOR=$simulator tools/write_reference.sh "$work/reference" 2> "$work/out" ||
    problem "tools/write_reference.sh: $(cat "$work/out")"
  for page in "$work"/reference/*.md; do
    diff -u "docs/reference/$(basename "$page")" "$page" > "$work/diff" ||
      problem "docs/reference/$(basename "$page"): not what tools/write_reference.sh writes:" "$(head -20 "$work/diff")"
  done
}

# All commands of the tutorial, in one shell as a reader has it, in a tree with the diagrams alone.
# Those of `sh page` need the viewer page.
check_tutorial_runs() {
  local page tree=$work/tree
  mkdir -p "$tree/tools" "$tree/build/release/tools"
  cp -r diagrams "$tree/"
  ln -s "$simulator" "$tree/build/release/tools/simulator"
  printf '#!/bin/sh\n' > "$tree/tools/setup.sh"
  chmod +x "$tree/tools/setup.sh"
  local kinds='^```sh$'
  [ -f "$(dirname "$simulator")/viewer/viewer.html" ] && kinds='^```sh( page)?$'
  for page in docs/tutorial/*.md; do
    awk -v open="$kinds" '$0 ~ open { on = 1; next } /^```$/ { on = 0 } on' "$page" > "$work/tutorial.sh"
    grep -q simulator "$work/tutorial.sh" || problem "$page: no command"
    (cd "$tree" && bash -euo pipefail "$work/tutorial.sh" < /dev/null > "$work/out" 2>&1) ||
      problem "$page: a command fails: $(tail -5 "$work/out")"
  done
}

check_systems_are_told() {
  local type
  for type in $("$simulator" list | awk '{ print $1 }'); do
    grep -q "\`$type\`" docs/architecture.md || problem "docs/architecture.md: does not name $type"
  done
}

check_systems_are_in_their_rooms() { # the table of docs/architecture.md says where each one lies
  local room names name
  while IFS='|' read -r _ room names _; do
    room=$(sed -E 's/^ *([a-z]+).*/\1/' <<< "$room")
    for name in $(grep -oE '`[A-Za-z]+`' <<< "$names" | tr -d '`'); do
      grep -rqE "^(class|struct|using) $name\b" "systems/$room" || problem "docs/architecture.md: $name; got room $room, where it is not"
    done
  done < <(sed -n '/^| room | systems |/,/^$/p' docs/architecture.md | tail -n +3)
}

check_commands_are_there() {
  local page command
  "$simulator" --help | sed -n '/^Subcommands:/,$p' | awk 'NR > 1 && /^  [a-z]/ { print $1 }' > "$work/commands"
  for page in $(pages); do
    for command in $(awk '/^```/ { code = !code } code' "$page" | grep -oE '(^|[|]) *\$?simulator [a-z]+' | awk '{ print $NF }' | sort -u); do
      grep -qxF "$command" "$work/commands" || problem "$page: simulator $command, which is no command"
    done
  done
}

check_examples_are_short_and_told() {
  local file count=0 lines
  for file in tools/examples/[0-9][0-9]_*.cc; do
    count=$((count + 1))
    lines=$(wc -l < "$file")
    [ "$lines" -le 60 ] || problem "$file: $lines lines; expected at most 60"
    [[ $(basename "$file") == $(printf %02d "$count")_* ]] || problem "$file: expected number $count"
    grep -qF "(../$file)" docs/cpp.md || problem "docs/cpp.md: does not name $file"
  done
  [ "$count" -ge 10 ] || problem "tools/examples: $count numbered programs; expected at least 10"
}

check_ports_are_members_of_their_names() {
  local member port seen=0
  while read -r member port; do
    seen=$((seen + 1))
    [ "$member" = push_back ] || [ "$member" = "$port" ] ||
      problem "systems: member $member is port $port; expected one name"
  done < <(cat systems/*/*.h systems/*/*.cc | tr '\n' ' ' |
    grep -oP '\b\w+\(\s*Declare(Input|OptionalInput|Output|StateOutput)\b(<[^()]*>)?\(\s*"\w+"' |
    sed -E 's/^(\w+)\(.*"(\w+)"$/\1 \2/')
  [ "$seen" -ge 100 ] || problem "systems: $seen ports found; expected at least 100"
}

check_one_name_is_one_class() { # of all headers, whatever the namespace
  local names name
  names=$(files '*.h' | grep -v '^tests/' | xargs cat |
    grep -oP '^(class|struct|enum class) \K\w+(?=( final)?( : [^{]*)? \{)')
  for name in $(sort <<< "$names" | uniq -d); do
    problem "headers: class $name twice; expected one name for one thing"
  done
  [ "$(wc -l <<< "$names")" -ge 500 ] || problem "headers: $(wc -l <<< "$names") classes found; expected at least 500"
}

target_of() { # FILE... -> FOLDER FILE, the folder that is the file's library or program
  local file folder
  for file; do
    folder=./${file%/*}
    while [ ! -e "$folder/CMakeLists.txt" ]; do folder=${folder%/*}; done
    echo "${folder#./} $file"
  done
}
# One compiler run reads several sources of a library (CMAKE_UNITY_BUILD), which ones is chance: names that
# they hide must differ, but for functions of other parameters and the same alias.
anonymous_names() { # -> FOLDER NAMESPACE NAME KIND FILE, of libraries, tests and benchmarks
  local folder file
  target_of $(files '*.cc') | while read -r folder file; do
    grep -qE '^(oca_(library|test)|add_executable\(oca_bench)' "$folder/CMakeLists.txt" && echo "$folder $file"
  done > "$work/sources"
  awk '
    function found(name, kind) { gsub(/ /, "_", kind); print folder, space, name, kind, file }
    function read_line(line) {
      sub(/^template <.*> /, "", line)
      sub(/^enum class /, "class ", line)
      if (match(line, /^(class|struct|enum) [A-Za-z_0-9]+/)) {
        if (substr(line, RLENGTH + 1) != ";") { split(line, word, /[ :;{]/); found(word[2], "type") }
      } else if (line ~ /^using [A-Za-z_0-9]+ =/) {
        split(line, word, " "); found(word[2], line)
      } else if (match(line, /^[^(=]*[ *&][A-Za-z_0-9]+\(/) && line !~ /^const[^(]* k[A-Z][A-Za-z_0-9]*\(/) {
        name = substr(line, 1, RLENGTH - 1); sub(/.*[ *&]/, "", name)
        kind = substr(line, RLENGTH); gsub(/ [A-Za-z_0-9]+[,)]/, ",", kind); sub(/ \{.*/, "", kind); found(name, kind)
      } else if (match(line, /^[^(={]*[ *&][A-Za-z_0-9]+(\[[^\]]*\])?( =|\{|\(|;)/)) {
        name = substr(line, 1, RLENGTH); sub(/(\[[^\]]*\])?( =|[{(;])$/, "", name); sub(/.*[ *&]/, "", name)
        found(name, "value")
      }
    }
    { folder = $1; file = $2; space = "-"; inside = 0
      while ((getline line < file) > 0) {
        if (match(line, /^namespace [a-z:]+ \{/)) space = substr(line, 11, RLENGTH - 12)
        if (line ~ /^namespace \{/) inside = 1
        if (line ~ /^}  \/\/ namespace$/) inside = 0
        if (inside && line ~ /^[A-Za-z]/ && line !~ /^(namespace|TEST|INSTANTIATE)/) read_line(line)
      }
      close(file)
    }' "$work/sources"
}

check_an_anonymous_name_is_once_a_target() {
  local name where file
  anonymous_names > "$work/names"
  awk '{ key = $1 " " $2 " " $3 }
       (key in kind) && file[key] != $5 && (kind[key] == $4 ? $4 !~ /^using/ : kind[key] $4 !~ /^\(.*\(/) { print $3, file[key], $5 }
       { kind[key] = $4; file[key] = $5 }' "$work/names" > "$work/twice"
  while read -r name where file; do problem "$file: $name, which $where has too; expected one anonymous name once in a library"; done < "$work/twice"
  [ "$(wc -l < "$work/names")" -ge 1500 ] || problem "anonymous names: $(wc -l < "$work/names") found; expected at least 1500"
}

check_the_counts_of_files_that_a_new_thing_touches() {
  local regex count got rows=0
  while IFS=$'\t' read -r regex count; do
    rows=$((rows + 1))
    got=$(bash tools/goals/knowing.sh "$regex" 2> /dev/null) || true
    [ "$got" = "$count" ] || problem "docs/how-to/what_to_touch.md: $regex: $count files; knowing.sh finds $got"
  done < <(sed -n 's/\\|/\x01/g; s/^| [^|]* | `\([^`]*\)` | \([0-9]*\) | .*/\1\t\2/p' docs/how-to/what_to_touch.md | tr '\001' '|')
  [ $rows -ge 6 ] || problem "docs/how-to/what_to_touch.md: $rows rows with a regex; expected at least 6"
}

installed_headers() { # as oca_library has it: all but INTERNAL_HEADERS and those of a namespace `internal`
  local lists folder
  for lists in $(files CMakeLists.txt | grep -E '^(framework|models|systems|diagrams)/'); do
    folder=$(dirname "$lists")
    tr '\n' ' ' < "$lists" | grep -oP 'INTERNAL_HEADERS\s+\K[^A-Z()]+' | tr -s ' ' '\n' | sed '/^$/d' | sed "s|^|$folder/|"
  done > "$work/internal"
  files '*.h' | grep -E '^(framework|models|systems|diagrams)/' | grep -vxFf "$work/internal" |
    xargs awk '/^namespace oca[a-z:]* \{/ && !/::internal \{/ { print FILENAME; nextfile }'
}

# Whoever includes it is of another library, or is installed for such a reason; or docs/cpp.md names it.
check_installed_headers_serve_somebody_else() {
  local header
  installed_headers > "$work/installed"
  target_of $(files '*.h' '*.cc' | grep -v '^tests/') > "$work/targets"
  files '*.h' '*.cc' | grep -v '^tests/' | xargs grep -oE '^#include "oca/[a-z0-9_/]+\.h"' | sed -E 's|:#include "oca/| |; s|"$||' > "$work/includes"
  grep -oE '`[a-z_]+/[a-z_/]+\.h`' docs/cpp.md | tr -d '`' > "$work/told"
  awk 'FILENAME ~ /targets$/ { target[$2] = $1 } FILENAME ~ /installed$/ { installed[$1] } FILENAME ~ /told$/ { serves[$1] }
       FILENAME ~ /includes$/ { user[++n] = $1; used[n] = $2; if (target[$1] != target[$2]) serves[$2] }
       END {
         do { more = 0; for (i = 1; i <= n; ++i) if ((user[i] in serves) && (user[i] in installed) && !(used[i] in serves)) { serves[used[i]]; more = 1 } } while (more)
         for (header in installed) if (!(header in serves)) print header
       }' "$work/targets" "$work/installed" "$work/told" "$work/includes" | sort > "$work/idle"
  while read -r header; do problem "$header: installed; got sources of its own library alone that include it; expected it in INTERNAL_HEADERS"; done < "$work/idle"
  [ "$(wc -l < "$work/installed")" -ge 200 ] || problem "headers: $(wc -l < "$work/installed") installed ones found; expected at least 200"
}

# Its second line is a comment; commands are of commands.h and named by it, a program is its main.
check_sources_without_a_header_say_what_they_are() {
  local file
  for file in $(files '*.cc' | grep -E '^(framework|models|systems|diagrams|tools/simulator)/' | grep -vE '_commands?\.cc$'); do
    [ -e "${file%.cc}.h" ] || [[ $(sed -n 2p "$file") == //* ]] || problem "$file: no header of its name; got no line of what it is; expected one after the licence's"
  done
}

# clang-format, which leaves comments as they are, has the code; `://` is a link, which no line can break.
check_comments_end_at_column_100() {
  local place
  while read -r place; do problem "$place: a comment beyond column 100"; done < <(
    files '*.h' '*.cc' | LC_ALL=C.UTF-8 xargs grep -nE '^.{101,}$' | grep -E '^[^:]+:[0-9]+: *//|///<' | grep -v '[a-z]://' | cut -d: -f1,2)
}

all=$(declare -F | awk '{ print $3 }' | grep '^check_' | sed 's/^check_//')
for name in ${*:-$all}; do
  declare -F "check_$name" > /dev/null || { echo "no such check: $name; there are: $(tr '\n' ' ' <<< "$all")" >&2; exit 2; }
  "check_$name"
done
echo "$problems problems"
[ "$problems" -eq 0 ]
