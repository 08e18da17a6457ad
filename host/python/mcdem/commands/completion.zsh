#compdef mcdem
# zsh completion of mcdem, as `mcdem completion zsh` writes it
_mcdem() {
    local line
    local -a candidates
    for line in "${(@f)$(${~words[1]} complete -- "${(@)words[2,CURRENT]}" 2> /dev/null)}"; do
        case $line in
        :files) _files ;;
        :folders) _files -/ ;;
        *=) compadd -S '' -- $line ;;
        *) candidates+=("${${line//:/\\:}/$'\t'/:}") ;;
        esac
    done
    if (( $#candidates )); then _describe mcdem candidates; fi
}
if [[ $funcstack[1] == _mcdem ]]; then _mcdem "$@"; else compdef _mcdem mcdem; fi
