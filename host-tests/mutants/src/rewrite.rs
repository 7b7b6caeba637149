//! The mutants of a file, each behind its switch: `if on(k) { mutant } else { original }`.

use std::collections::{HashMap, HashSet};

use proc_macro2::{LineColumn, Span};
use syn::spanned::Spanned;
use syn::visit_mut::{self, VisitMut};
use syn::{Attribute, BinOp, Block, Expr, ImplItemFn, Item, ItemFn, Member, Signature, TraitItemFn, Type, parse_quote};

use crate::list::Mutant;

/// The text of a file with these of its mutants behind switches, and which of them were found in it.
pub fn rewrite(source: &str, mutants: &[&Mutant]) -> (String, HashSet<u32>) {
    let mut places: HashMap<(usize, usize), Vec<&Mutant>> = HashMap::new();
    for mutant in mutants {
        places.entry((mutant.span.start.line, mutant.span.start.column)).or_default().push(mutant);
    }
    let mut file = syn::parse_file(source).expect("a file that compiles");
    let mut rewriter = Rewriter { places, switched: HashSet::new(), constant: false };
    rewriter.visit_file_mut(&mut file);
    (prettyplease::unparse(&file), rewriter.switched)
}

struct Rewriter<'a> {
    places: HashMap<(usize, usize), Vec<&'a Mutant>>,
    switched: HashSet<u32>,
    /// Within a `const fn`, where operators are those of numbers alone.
    constant: bool,
}

impl<'a> Rewriter<'a> {
    fn at(&mut self, span: Span, genre: &str) -> Vec<&'a Mutant> {
        let LineColumn { line, column } = span.start();
        let here = self.places.get(&(line, column + 1)).into_iter().flatten();
        let found: Vec<_> = here.filter(|mutant| mutant.genre == genre).copied().collect();
        self.switched.extend(found.iter().map(|mutant| mutant.number));
        found
    }

    fn function(&mut self, signature: &Signature, block: &mut Block) {
        let outer = std::mem::replace(&mut self.constant, signature.constness.is_some());
        let body = block.stmts.first().map(Spanned::span);
        self.visit_block_mut(block);
        self.constant = outer;
        for mutant in body.map(|span| self.at(span, "FnValue")).unwrap_or_default().into_iter().rev() {
            let (number, value) = (mutant.number, expression(&mutant.replacement));
            block.stmts.insert(0, parse_quote! { if crate::switch::on(#number) { return #value; } });
        }
    }

    fn binary(&mut self, expr: &mut Expr) {
        let Expr::Binary(binary) = expr else { return };
        if has_let(&binary.left) || has_let(&binary.right) {
            return;
        }
        let (left, right, op) = (&binary.left, &binary.right, binary.op);
        let mutants = self.at(op.span(), "BinaryOperator");
        if mutants.is_empty() {
            return;
        }
        let number = mutants[0].number;
        // and and or: the right side is evaluated as often as without a switch
        *expr = match op {
            BinOp::And(_) if mutants.len() == 1 => {
                parse_quote! { (match (#left) { x => if x != crate::switch::on(#number) { #right } else { x } }) }
            }
            BinOp::Or(_) if mutants.len() == 1 => {
                parse_quote! { (match (#left) { x => if x == crate::switch::on(#number) { #right } else { x } }) }
            }
            _ if assigns(&op) => {
                let mut out: Expr = parse_quote! { #left #op y };
                for mutant in mutants.iter().rev() {
                    let (number, op) = (mutant.number, operator(&mutant.replacement));
                    out = parse_quote! { if crate::switch::on(#number) { #left #op y } else { #out } };
                }
                parse_quote! { (match (#right) { y => #out }) }
            }
            _ => {
                let mut out: Expr = parse_quote! { x #op y };
                for mutant in mutants.iter().rev() {
                    let (number, op) = (mutant.number, operator(&mutant.replacement));
                    out = parse_quote! { if crate::switch::on(#number) { x #op y } else { #out } };
                }
                if compares(&op) && !self.constant {
                    parse_quote! { (match (&(#left), &(#right)) { (x, y) => #out }) }
                } else {
                    parse_quote! { (match (#left, #right) { (x, y) => #out }) }
                }
            }
        };
    }

    fn unary(&mut self, expr: &mut Expr) {
        let Expr::Unary(unary) = expr else { return };
        let (op, operand) = (unary.op, &unary.expr);
        if let [mutant] = self.at(op.span(), "UnaryOperator")[..] {
            let number = mutant.number;
            *expr = parse_quote! { (match (#operand) { x => if crate::switch::on(#number) { x } else { #op x } }) };
        }
    }

    fn structure(&mut self, expr: &mut Expr) {
        let Expr::Struct(structure) = expr else { return };
        let original = structure.clone();
        for field in &original.fields {
            if let [mutant] = self.at(field.member.span(), "StructField")[..] {
                let mut without = original.clone();
                without.fields.clear();
                for other in original.fields.iter().filter(|other| name(other) != name(field)) {
                    without.fields.push_value(other.clone());
                    without.fields.push_punct(Default::default());
                }
                let (number, out) = (mutant.number, expr.clone());
                *expr = parse_quote! { (if crate::switch::on(#number) { #without } else { #out }) };
            }
        }
    }
}

fn name(field: &syn::FieldValue) -> String {
    match &field.member {
        Member::Named(name) => name.to_string(),
        Member::Unnamed(index) => index.index.to_string(),
    }
}

fn expression(text: &str) -> Expr {
    syn::parse_str(text).unwrap_or_else(|_| panic!("an expression: {text}"))
}

fn operator(text: &str) -> BinOp {
    syn::parse_str(text).unwrap_or_else(|_| panic!("an operator: {text}"))
}

fn has_let(expr: &Expr) -> bool {
    match expr {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

fn compares(op: &BinOp) -> bool {
    matches!(op, BinOp::Eq(_) | BinOp::Ne(_) | BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_))
}

fn assigns(op: &BinOp) -> bool {
    use BinOp::*;
    let sums = matches!(op, AddAssign(_) | SubAssign(_) | MulAssign(_) | DivAssign(_) | RemAssign(_));
    sums || matches!(op, BitXorAssign(_) | BitAndAssign(_) | BitOrAssign(_) | ShlAssign(_) | ShrAssign(_))
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Ident>().is_ok_and(|name| name == "test")
    })
}

impl VisitMut for Rewriter<'_> {
    fn visit_item_mut(&mut self, item: &mut Item) {
        match item {
            // evaluated by the compiler, where a switch is always off
            Item::Const(_) | Item::Static(_) => {}
            Item::Mod(module) if is_test(&module.attrs) => {}
            _ => visit_mut::visit_item_mut(self, item),
        }
    }

    fn visit_impl_item_const_mut(&mut self, _: &mut syn::ImplItemConst) {}

    fn visit_trait_item_const_mut(&mut self, _: &mut syn::TraitItemConst) {}

    fn visit_type_mut(&mut self, _: &mut Type) {}

    fn visit_pat_mut(&mut self, _: &mut syn::Pat) {}

    fn visit_generics_mut(&mut self, _: &mut syn::Generics) {}

    fn visit_path_mut(&mut self, _: &mut syn::Path) {}

    fn visit_item_fn_mut(&mut self, function: &mut ItemFn) {
        self.function(&function.sig, &mut function.block);
    }

    fn visit_impl_item_fn_mut(&mut self, function: &mut ImplItemFn) {
        self.function(&function.sig, &mut function.block);
    }

    fn visit_trait_item_fn_mut(&mut self, function: &mut TraitItemFn) {
        if let Some(block) = &mut function.default {
            self.function(&function.sig, block);
        }
    }

    fn visit_expr_repeat_mut(&mut self, repeat: &mut syn::ExprRepeat) {
        self.visit_expr_mut(&mut repeat.expr);
    }

    fn visit_expr_const_mut(&mut self, _: &mut syn::ExprConst) {}

    fn visit_arm_mut(&mut self, arm: &mut syn::Arm) {
        let span = arm.span();
        let guard = arm.guard.as_ref().map(|(_, guard)| guard.span());
        visit_mut::visit_arm_mut(self, arm);
        for mutant in guard.map(|span| self.at(span, "MatchArmGuard")).unwrap_or_default() {
            let (number, value) = (mutant.number, expression(&mutant.replacement));
            if let Some((_, guard)) = &mut arm.guard {
                *guard = parse_quote! { (if crate::switch::on(#number) { #value } else { #guard }) };
            }
        }
        if let [mutant] = self.at(span, "MatchArm")[..] {
            let number = mutant.number;
            let off: Expr = parse_quote! { !crate::switch::on(#number) };
            arm.guard = Some(match arm.guard.take() {
                Some((token, guard)) => (token, parse_quote! { #off && (#guard) }),
                None => (Default::default(), Box::new(off)),
            });
        }
    }

    fn visit_expr_mut(&mut self, expr: &mut Expr) {
        visit_mut::visit_expr_mut(self, expr);
        match expr {
            Expr::Binary(_) => self.binary(expr),
            Expr::Unary(_) => self.unary(expr),
            Expr::Struct(_) => self.structure(expr),
            _ => {}
        }
    }
}
